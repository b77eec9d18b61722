#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "capstan/effects/effect_catalogue.h"
#include "capstan/effects/known_causes.h"

namespace capstan {
namespace {

TEST(KnownCauses, HaveEachNameOnceWithTitleAndFamily) {
    std::set<std::string> names;
    for (const KnownCause& cause : known_causes()) {
        EXPECT_TRUE(names.insert(cause.name).second) << cause.name;
        EXPECT_FALSE(cause.title.empty()) << cause.name;
        EXPECT_FALSE(cause.family.empty()) << cause.name;
    }
    for (const Effect& effect : effect_catalogue()) EXPECT_TRUE(names.contains(effect.name));
}

TEST(KnownCauses, ConfusableMeansConfusableBothWays) {
    for (const KnownCause& cause : known_causes()) {
        const std::vector<std::string> rivals = confusable_causes(cause.name);
        EXPECT_EQ(std::set<std::string>(rivals.begin(), rivals.end()).size(), rivals.size()) << cause.name;
        for (const std::string& rival : rivals) {
            ASSERT_NE(find_cause(rival), nullptr) << rival;
            const std::vector<std::string> back = confusable_causes(rival);
            EXPECT_NE(std::find(back.begin(), back.end(), cause.name), back.end())
                << cause.name << " " << rival;
        }
    }
    EXPECT_EQ(confusable_causes("conduit_compliance"),
              (std::vector<std::string>{"environment_coupling", "cable_stiffness_nonlinear"}));
}

TEST(KnownCauses, AnAnswerNamesWhatIsNotCanonicalUnknown) {
    for (const char* cause : {"directional_friction", "friction_drift", "sensor_clipping"}) {
        ASSERT_NE(find_cause(cause), nullptr) << cause;
        EXPECT_EQ(answered_name(cause), "unknown");
    }
    EXPECT_EQ(answered_name("stribeck"), "stribeck");
    EXPECT_EQ(answered_name("none"), "none");
}

TEST(KnownCauses, ANameOutsideTheCataloguesIsItsOwnTitle) {
    EXPECT_EQ(cause_title("viscous_friction"), "viscous friction");
    EXPECT_EQ(cause_title("unknown"), "unknown");
    EXPECT_EQ(find_cause("unknown"), nullptr);
}

}  // namespace
}  // namespace capstan
