#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "capstan/service/cost_estimate.h"
#include "capstan/service/import_folder.h"

namespace capstan::service {
namespace {

// Stands for the program that the service calls.
class CostEstimate : public testing::Test {
  protected:
    ordered_json cost_where_the_program(const std::string& does) {
        const std::string program = (folder_.path() / "program").string();
        std::ofstream(program) << "#!/bin/sh\n" << does << "\n";
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        JobCommands commands;
        commands.program = program;
        commands.threads = 2;
        return cost_of_studies(commands, "", false);
    }

  private:
    PrivateFolder folder_{"capstan-test"};
};

TEST_F(CostEstimate, ARefusedConfigurationIsLeftToTheStart) {
    EXPECT_EQ(cost_where_the_program("exit 2"), ordered_json({{"known", false}}));
}

// A busy machine may kill the plan, or take longer than is waited for. A page then asks before it starts.
TEST_F(CostEstimate, AnEstimateThatWasCutOffMayBeLong) {
    const ordered_json may_be_long = {{"known", false}, {"may_be_long", true}};
    EXPECT_EQ(cost_where_the_program("kill -9 $$"), may_be_long);
    EXPECT_EQ(cost_where_the_program("echo '{\"studies\": '"), may_be_long);
}

TEST_F(CostEstimate, SecondsAreProcessorTimeOverProcessors) {
    const ordered_json cost = cost_where_the_program("echo '{\"studies\": 3, \"one_run_core_hours\": 0.5}'");
    EXPECT_EQ(cost.at("studies"), 3);
    EXPECT_EQ(cost.at("processor_s"), 1800.0);
    EXPECT_EQ(cost.at("seconds"), 900.0);
}

}  // namespace
}  // namespace capstan::service
