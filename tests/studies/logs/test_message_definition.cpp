// The texts that describe messages, as files from anywhere carry them.
#include <gmock/gmock.h>

#include "capstan/logs/message_definition.h"

namespace capstan::logs {
namespace {

using testing::HasSubstr;

std::string why_not(const std::string& type, const std::string& text,
                    MessageDialect dialect = MessageDialect::ros1) {
    try {
        parse_definition(type, text, dialect);
    } catch (const UnknownMessage& why) {
        return why.what();
    }
    return "";
}

TEST(MessageDefinition, HasTheFieldsInOrderAndNoConstants) {
    const MessageDefinition definition = parse_definition(
        "lab/Motor",
        "# of a motor\r\nint8 OFF=0\nstring NAME = x # y\nfloat64   current # A\nuint8[3] flags\nPair[] pairs\nHeader header\n" +
            std::string(80, '=') + "\nMSG: lab/Pair\nfloat32 a\nduration b\n",
        MessageDialect::ros1);
    const MessageType& motor = definition.types.at(0);
    ASSERT_EQ(motor.fields.size(), 4u);
    EXPECT_EQ(motor.fields[0].name, "current");
    EXPECT_EQ(motor.fields[1].count, 3u);
    EXPECT_EQ(motor.fields[2].shape, FieldShape::sequence);
    const MessageType& pair = definition.types.at(static_cast<std::size_t>(motor.fields[2].message));
    EXPECT_EQ(pair.name, "lab/Pair");
    EXPECT_EQ(pair.min_bytes, 12u);
    EXPECT_EQ(motor.min_bytes, 8u + 3u + 4u + 16u);
}

TEST(MessageDefinition, KnowsTheCommonTypesOfRos2WithoutAText) {
    for (const char* type :
         {"sensor_msgs/msg/JointState", "geometry_msgs/msg/WrenchStamped", "geometry_msgs/msg/Wrench",
          "std_msgs/msg/Float64", "std_msgs/msg/Float32", "std_msgs/msg/Int32",
          "std_msgs/msg/Float64MultiArray", "std_msgs/msg/Float32MultiArray", "sensor_msgs/msg/Imu",
          "geometry_msgs/msg/Vector3Stamped", "geometry_msgs/msg/PointStamped",
          "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"})
        EXPECT_EQ(why_not(type, "", MessageDialect::ros2), "") << type;
    EXPECT_EQ(parse_definition("sensor_msgs/msg/Imu", "", MessageDialect::ros2).types[0].min_bytes,
              8u + 4u + 37 * 8u);
}

TEST(MessageDefinition, RefusesWhatWouldNotEnd) {
    EXPECT_THAT(why_not("lab/A", "A again\n"), HasSubstr("contains itself"));
    EXPECT_THAT(why_not("lab/A", "B b\n"), HasSubstr("definition of B is not in the file"));
    EXPECT_THAT(why_not("lab/A", "float64[99999999999] x\n"), HasSubstr("no sensible length"));
    EXPECT_THAT(why_not("lab/A", "float64[16777216] x\n"), HasSubstr("longer than the limit"));
    const std::string rule = std::string(80, '=') + "\nMSG: lab/";
    EXPECT_THAT(why_not("lab/A", "B[] many\n" + rule + "B\n# nothing\n"),
                HasSubstr("array of empty messages"));
    // Each type has two of the next: without a bound the fields are 2^30.
    std::string doubling = "T1 a\nT1 b\n", deep = "T1 a\n";
    for (int k = 1; k < 40; ++k) {
        const std::string next = "T" + std::to_string(k + 1);
        doubling += rule + "T" + std::to_string(k) + "\n" + next + " a\n" + next + " b\n";
        deep += rule + "T" + std::to_string(k) + "\n" + next + " a\n";
    }
    EXPECT_THAT(why_not("lab/A", doubling + rule + "T40\nfloat64 x\n"), HasSubstr("nested too deeply"));
    std::string shallow = "T1 a\nT1 b\n";
    for (int k = 1; k < 25; ++k)
        shallow += rule + "T" + std::to_string(k) + "\nT" + std::to_string(k + 1) + " a\nT" +
                   std::to_string(k + 1) + " b\n";
    EXPECT_THAT(why_not("lab/A", shallow + rule + "T25\nuint8 x\n"),
                testing::AnyOf(HasSubstr("too many"), HasSubstr("longer than")));
}

}  // namespace
}  // namespace capstan::logs
