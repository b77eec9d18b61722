#include <gtest/gtest.h>

#include "capstan/bench_model/calibration_numbers.h"
#include "capstan/calibration/calibration.h"
#include "full_model.h"
#include "lumped_session.h"

namespace capstan::bench_model {
namespace {

std::map<std::string, double> by_name(const std::vector<FittedNumber>& numbers) {
    std::map<std::string, double> values;
    for (const FittedNumber& number : numbers) values[number.name] = number.value;
    return values;
}

// A model that was found without a cause says of a drive what its calibration found.
TEST(CalibrationNumbers, OfADriveAreThoseOfItsCalibration) {
    const Recording session = gap::lumped_session({});
    BenchModel model;
    model.recorded_mode = BenchMode::lumped_drive;
    model.description = gap::fit_equivalence(session);
    model.friction_ratio.value = model.stiffness_ratio.value = model.pretension_ratio.value = 1.0;
    const std::map<std::string, double> values = by_name(calibration_numbers(model));
    const gap::Calibration calibration = gap::calibrate(session, {});
    ASSERT_EQ(values.size(), calibration.parameters.size());
    for (const gap::ParameterEstimate& fitted : calibration.parameters)
        EXPECT_NEAR(values.at(fitted.parameter.name), fitted.value, 1e-9 * fitted.value)
            << fitted.parameter.name;
}

TEST(CalibrationNumbers, OfABenchAreItsNominalOnesTimesTheirRatios) {
    const BenchModel model = full_model();
    const std::map<std::string, double> values = by_name(calibration_numbers(model));
    EXPECT_EQ(values.at("dynamic_friction"), 0.2 * model.friction_ratio.value);
    EXPECT_EQ(values.at("axial_stiffness"), 4000.0 * model.stiffness_ratio.value);
    EXPECT_EQ(values.at("pretension"), model.pretension_ratio.value);
}

TEST(CalibrationNumbers, AsAStartLeadToTheSameFit) {
    const Recording session = gap::lumped_session({});
    gap::CalibrationOptions far_away;
    far_away.start = {{"friction_exponent", 0.1}, {"pretension", 1.0}, {"not_a_parameter", 3.0}};
    const std::vector<double> from_nominal = gap::calibrate(session, {}).values();
    const std::vector<double> from_there = gap::calibrate(session, far_away).values();
    for (std::size_t k = 0; k < from_nominal.size(); ++k)
        EXPECT_NEAR(from_there[k], from_nominal[k], 0.02 * from_nominal[k]);
}

}  // namespace
}  // namespace capstan::bench_model
