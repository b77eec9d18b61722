#include <array>
#include <utility>

#include "capstan/logs/message_definition.h"

namespace capstan::logs {

namespace {

// As common_interfaces and rcl_interfaces of ROS 2 have them; a rosbag2 before Iron does not carry them.
constexpr std::pair<std::string_view, std::string_view> common_texts[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
    {"std_msgs/Bool", "bool data"},
    {"std_msgs/Int8", "int8 data"},
    {"std_msgs/UInt8", "uint8 data"},
    {"std_msgs/Int16", "int16 data"},
    {"std_msgs/UInt16", "uint16 data"},
    {"std_msgs/Int32", "int32 data"},
    {"std_msgs/UInt32", "uint32 data"},
    {"std_msgs/Int64", "int64 data"},
    {"std_msgs/UInt64", "uint64 data"},
    {"std_msgs/Float32", "float32 data"},
    {"std_msgs/Float64", "float64 data"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride"},
    {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset"},
    {"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data"},
    {"std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data"},
    {"std_msgs/Int32MultiArray", "MultiArrayLayout layout\nint32[] data"},
    {"std_msgs/Int16MultiArray", "MultiArrayLayout layout\nint16[] data"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
    {"geometry_msgs/Accel", "Vector3 linear\nVector3 angular"},
    {"geometry_msgs/Wrench", "Vector3 force\nVector3 torque"},
    {"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point"},
    {"geometry_msgs/QuaternionStamped", "std_msgs/Header header\nQuaternion quaternion"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
    {"geometry_msgs/TransformStamped", "std_msgs/Header header\nstring child_frame_id\nTransform transform"},
    {"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist"},
    {"geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel"},
    {"geometry_msgs/WrenchStamped", "std_msgs/Header header\nWrench wrench"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance"},
    {"sensor_msgs/MagneticField",
     "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance"},
    {"sensor_msgs/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance"},
    {"sensor_msgs/FluidPressure", "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance"},
    {"sensor_msgs/Range",
     "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
     "float32 max_range\nfloat32 range"},
};

}  // namespace

std::string_view common_definition(std::string_view type, MessageDialect dialect) {
    if (dialect == MessageDialect::ros1 && type == "std_msgs/Header")
        return "uint32 seq\ntime stamp\nstring frame_id";
    for (const auto& [name, text] : common_texts)
        if (name == type) return text;
    return {};
}

}  // namespace capstan::logs
