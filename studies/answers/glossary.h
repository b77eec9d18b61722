#pragma once
// The words of answers, pages and configurations, explained once.

#include <string>
#include <string_view>
#include <vector>

#include "capstan/reports/answer.h"

namespace capstan::answers {

struct GlossaryTerm {
    std::string name;  ///< as a reader meets it: "feasible curve", "viscous friction"
    std::string also;  ///< its canonical name in JSON, SQL and configurations, or another word; may be empty
    std::string kind;  ///< "term", "fusion method", "effect", "sensor fault", "layout"
    std::string meaning;  ///< one or two sentences
};

/// Terms, layouts, then the catalogues of fusion methods, effects and sensor faults.
const std::vector<GlossaryTerm>& glossary();

/// Every term of this name, whatever its case, with blanks or underscores.
std::vector<GlossaryTerm> terms_named(std::string_view name);

/// All of it, as a page or a text.
reports::Answer glossary_answer();

}  // namespace capstan::answers
