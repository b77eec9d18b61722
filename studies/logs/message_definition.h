#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace capstan::logs {

enum class FieldKind {
    boolean,
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64,
    time,      ///< seconds and nanoseconds since an epoch, 4 bytes each
    duration,  ///< the same, signed
    string,
    message
};

/// Bytes of a number, a time or a duration.
std::size_t size_of(FieldKind kind);

enum class FieldShape { one, fixed_array, sequence };

struct MessageField {
    std::string name;
    FieldKind kind = FieldKind::float64;
    int message = -1;  ///< index in the types, of a nested message
    FieldShape shape = FieldShape::one;
    std::size_t count = 1;  ///< of a fixed array
};

struct MessageType {
    std::string name;  ///< "geometry_msgs/Wrench"
    std::vector<MessageField> fields;
    std::size_t min_bytes = 0;  ///< no message of this type is shorter; at least one, but for an empty one
    std::size_t fields_in_all = 0;  ///< with those of nested messages
};

/// A type of message and all that it is made of; the first is the type itself, and none contains itself.
struct MessageDefinition {
    std::vector<MessageType> types;
};

/// Why a type's messages cannot be read, as an end of a sentence.
struct UnknownMessage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class MessageDialect { ros1, ros2 };
enum class MessageEncoding { ros1, cdr };

/// From the text that bags and MCAP files carry: the fields of `type`, one a line, then after each line of
/// '=' the types it uses ("MSG: geometry_msgs/Wrench"). A type whose text is not there, and every type for
/// an empty `text`, is looked up among the common ones. Throws UnknownMessage.
MessageDefinition parse_definition(std::string_view type, std::string_view text, MessageDialect dialect);

/// "sensor_msgs/JointState" for "sensor_msgs/msg/JointState".
std::string short_type(std::string_view type);

/// The text of a common type ("sensor_msgs/JointState"); empty if it is not one of them.
std::string_view common_definition(std::string_view type, MessageDialect dialect);

}  // namespace capstan::logs
