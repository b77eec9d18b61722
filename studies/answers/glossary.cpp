#include "capstan/answers/glossary.h"

#include <algorithm>
#include <cctype>

#include "capstan/effects/effect_catalogue.h"
#include "capstan/effects/sensor_faults.h"
#include "capstan/estimation/fusion_method.h"

namespace capstan::answers {

namespace {

const GlossaryTerm terms[] = {
    {"node", "", "term",
     "A point of the cable at which its tension is computed and a sensor can be. Nodes are counted from 1 at the "
     "motor; the last one is the load end."},
    {"segment", "", "term",
     "The piece of cable between two neighbouring nodes. It has a length, a curvature and a stiffness."},
    {"proximal", "motor end", "term", "At or near the motor."},
    {"distal", "load end", "term", "At or near the load."},
    {"regime", "", "term",
     "How the cable moves at an instant: all of it slides (mass), or only a part of it does (partial), at the motor, "
     "at the load, or at both ends."},
    {"instant", "sample", "term",
     "One moment of the true motion, at which sensors are read and tensions are estimated."},
    {"scenario", "", "term", "One instant in one regime, with the tension of every node."},
    {"layout", "", "term", "A named way to place sensors, such as Even from the load end with 3 sensors."},
    {"sensor set", "", "term", "The nodes that have a sensor. Several layouts can name the same set."},
    {"repetition", "draw", "term",
     "One random draw of the noise of all sensors, and of the cable where it is uncertain."},
    {"independent draws", "fresh draws", "term",
     "Draws that had no part in a choice. The error of the best of many layouts is smaller on the draws that chose it "
     "than it will be in use, so it is estimated again on independent draws."},
    {"regret", "minimax regret", "term",
     "How much larger an error is than that of the best choice in the same regime. The largest regret over the "
     "regimes is what a layout for all regimes is chosen by."},
    {"duty cycle", "", "term", "How much of the time the transmission is in each regime."},
    {"world", "", "term",
     "One cable and motion drawn from what is uncertain of them ([uncertainty] of a configuration)."},
    {"unit", "work unit", "term",
     "A piece of a study that is computed and stored at once; a stopped study goes on with the next."},
    {"shard", "", "term",
     "A part of a study that runs by itself, on another machine for example, and is merged afterwards."},
    {"interval", "", "term",
     "The range that holds the true value in 95 of 100 studies. A Monte-Carlo interval covers the finite number of draws, "
     "and no error of the model."},
    {"feasible state", "feasible curve", "term",
     "A set of tensions along the cable that the model can have reached. All feasible states of an instant form a curve, "
     "and a reading says where on it the cable is."},
    {"direction known", "", "term",
     "The estimator is told which way each part of the cable slides. Without that it finds out from the readings."},
    {"fusion", "fusion method", "term",
     "How the readings of several sensors become one estimate of all tensions."},
    {"pretension", "pretension_N", "term", "The tension of the cable at rest [N]."},
    {"friction ratio", "friction_ratio", "term",
     "True friction over nominal friction; 1 where the nominal value is right."},
    {"nominal", "", "term", "What the model assumes: from data sheets, or as it was before a calibration."},
    {"gap", "sim-to-real gap", "term",
     "What a recording has and its model does not: the difference that a diagnosis explains."},
    {"residual", "", "term", "The recorded value less the value of the model at the same instant."},
    {"cause", "", "term",
     "An effect, a wrong nominal number or a sensor fault that can explain a gap. A diagnosis gives each a probability."},
    {"recording", "", "term",
     "A log of a bench as capstan reads it: NAME.csv with the channels, and NAME.json, its sidecar, with the bench."},
    {"sidecar", "", "term", "The JSON file beside a recording that describes the bench and the channels."},
    {"loop exponent", "loop_exponent", "term",
     "How a sensor with hysteresis reads after a reversal: with 0 it stands still until the loop is crossed (a play), with 0.5 it "
     "follows a parabola (Rayleigh's law), with 1 an exponential."},
    {"Even", "even", "layout", "A sensor at every p-th node, counted from one end, with p as large as fits."},
    {"Distal", "distal layout", "layout", "Neighbouring sensors at the load end."},
    {"Both", "both", "layout",
     "As many sensors at the motor end as at the load end; an odd one is at either."},
};

std::string plain(std::string_view text) {
    std::string word;
    for (const char letter : text)
        word += letter == '_' || letter == '-'
                    ? ' '
                    : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return word;
}

std::vector<GlossaryTerm> all_terms() {
    std::vector<GlossaryTerm> all(std::begin(terms), std::end(terms));
    for (const FusionMethod& method : fusion_methods())
        all.push_back({std::string(method.title), std::string(method.name), "fusion method",
                       std::string(method.meaning)});
    for (const Effect& effect : effect_catalogue()) {
        const std::string variant = effect.variant.empty() ? "" : " (" + effect.variant + ")";
        all.push_back({effect.title + variant, effect.name, "effect", effect.meaning});
    }
    for (const SensorFault& fault : sensor_fault_catalogue())
        all.push_back({fault.title + (fault.variant.empty() ? "" : " (" + fault.variant + ")"), fault.name,
                       "sensor fault",
                       "A fault of a sensor that a diagnosis can name" +
                           (fault.unit.empty() ? std::string(".") : "; its size is in " + fault.unit + ".")});
    return all;
}

}  // namespace

const std::vector<GlossaryTerm>& glossary() {
    static const std::vector<GlossaryTerm> all = all_terms();
    return all;
}

std::vector<GlossaryTerm> terms_named(std::string_view name) {
    const std::string wanted = plain(name);
    std::vector<GlossaryTerm> found;
    std::ranges::copy_if(glossary(), std::back_inserter(found), [&](const GlossaryTerm& term) {
        return plain(term.name) == wanted || plain(term.also) == wanted;
    });
    return found;
}

reports::Answer glossary_answer() {
    reports::Data rows = reports::Data::list();
    for (const GlossaryTerm& term : glossary())
        rows.push_back(
            {{"name", term.name}, {"also", term.also}, {"kind", term.kind}, {"meaning", term.meaning}});
    reports::Answer answer{
        .id = "glossary",
        .kind = "Glossary",
        .title = "The words of capstan",
        .headline = "What the terms, layouts, methods, effects and faults of answers and pages mean."};
    answer.values = {{"terms", rows}};
    answer.sections.push_back(
        {.id = "terms",
         .heading = "Terms",
         .tables = {
             {.id = "terms",
              .caption = "In the shell: capstan help TERM.",
              .columns = {{"name", "term"}, {"also", "also"}, {"kind", "kind"}, {"meaning", "meaning"}},
              .rows = rows}}});
    return answer;
}

}  // namespace capstan::answers
