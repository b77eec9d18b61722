#pragma once

#include <string>

namespace capstan::service {

/// The content security policy of the service's own pages: they run and load only its files, and no other
/// page can frame them. The charts compile their expressions, which needs 'unsafe-eval'.
const std::string& page_policy();

/// The same for a page that holds its scripts in itself, as a report does: these scripts, by their hashes,
/// and no other.
const std::string& self_contained_page_policy();

inline constexpr const char* policy_header = "Content-Security-Policy";

}  // namespace capstan::service
