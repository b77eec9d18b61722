#pragma once

#include <string>
#include <vector>

namespace capstan::printing {

/// The name of a browser on PATH that can run without a window (chromium, chrome); empty if there is none.
std::string browser_on_path();

/// A page of a report as a PDF. Throws std::runtime_error if there is no browser or it fails.
std::string pdf_of(const std::string& page_html);

struct FigureFile {
    std::string name;  ///< "knee.svg", "knee.png"
    std::string bytes;
};

inline constexpr int smallest_width_px = 300;
inline constexpr int largest_width_px = 2000;

/// Every figure of the page as SVG and PNG, in the colours of print; `width_px` in CSS pixels, of which an
/// inch has 96. A PNG has four times as many. Throws std::runtime_error as pdf_of() does.
std::vector<FigureFile> figures_of(const std::string& page_html, int width_px);

}  // namespace capstan::printing
