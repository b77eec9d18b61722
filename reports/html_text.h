#pragma once
// Values as people read them, and text that may safely stand in HTML.

#include <optional>
#include <string>
#include <string_view>

namespace capstan::reports {

std::string escape_html(std::string_view text);  // for content and for quoted attributes

std::string newtons(double value_N);                       // '0.126 N'
std::string newtons_between(double low_N, double high_N);  // '0.122 to 0.131 N'
std::string plain_number(double value, int significant_digits = 3);
std::string percent(double fraction);  // '60 %'

std::string regime_title(std::string_view regime);  // 'Partial motion, proximal side'

}  // namespace capstan::reports
