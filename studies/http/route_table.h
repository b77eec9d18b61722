#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/http/response.h"

namespace capstan::http {

/// Which handler answers which path. A path has {name} for any one segment, and other words in braces for a
/// segment of digits: /api/configs/{name}, /api/jobs/{job}.
class RouteTable {
  public:
    struct Entry {
        std::string method;  ///< "GET" or "POST"
        std::vector<std::string> segments;
        Handler handler;
        std::size_t lane = 0;
    };

    void add(std::string method, std::string_view path, Handler handler, std::size_t lane = 0);

    struct Found {
        const Entry* entry = nullptr;
        std::vector<std::string> path_values;
        bool other_method = false;  ///< the path is there, but not with this method
    };
    /// HEAD finds what GET does.
    Found find(std::string_view method, std::string_view path) const;

  private:
    std::vector<Entry> entries_;
};

}  // namespace capstan::http
