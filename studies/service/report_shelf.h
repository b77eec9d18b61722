#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "capstan/http/kept_text.h"

namespace capstan::service {

/// A cache of texts that are expensive to make. A text is kept until the state that it was made from changes.
/// While a new text is made, a request that accepts an older one gets the previous text; such a text is made
/// again no sooner than a moment after the last time. When the cache is full, the least recently used text is
/// dropped.
class ReportShelf {
  public:
    using Maker = std::function<std::string()>;

    enum class Freshness {
        exact,         ///< made from this very state
        just_made,     ///< or less than a moment ago; a request that comes sooner waits
        a_moment_old,  ///< or the previous one, while a new one is made
    };

    /// `state`: what the text depends on, as "12 of 40 units".
    std::shared_ptr<const http::KeptText> get(const std::string& name, const std::string& state,
                                              Freshness freshness, const Maker& make);

  private:
    using Clock = std::chrono::steady_clock;

    struct Place {
        std::mutex making;   // held while a text is made
        std::mutex reading;  // held for a look at what follows
        std::string state;
        std::shared_ptr<const http::KeptText> text;
        Clock::time_point made;
    };
    struct Entry {
        std::shared_ptr<Place> place;
        std::uint64_t asked = 0;  // the larger, the later it was asked for
        std::size_t bytes = 0;    // of its text
    };

    std::shared_ptr<Place> place(const std::string& name);
    void make_room(const std::string& name, std::size_t bytes);
    void drop_the_oldest();  // but one, until there is room; while locked

    std::mutex mutex_;
    std::map<std::string, Entry> places_;
    std::uint64_t asked_ = 0;
};

}  // namespace capstan::service
