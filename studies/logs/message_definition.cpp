#include "capstan/logs/message_definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "capstan/logs/log.h"
#include "capstan/logs/text_cells.h"

namespace capstan::logs {

namespace {

constexpr std::size_t longest_definition = 1u << 20;
constexpr std::size_t max_types = 512;
constexpr std::size_t max_fields = 1u << 14;
constexpr int deepest_nesting = 32;

struct NamedKind {
    std::string_view name;
    FieldKind kind;
};
constexpr NamedKind named_kinds[] = {
    {"bool", FieldKind::boolean},    {"int8", FieldKind::int8},        {"uint8", FieldKind::uint8},
    {"byte", FieldKind::uint8},      {"char", FieldKind::uint8},       {"octet", FieldKind::uint8},
    {"int16", FieldKind::int16},     {"uint16", FieldKind::uint16},    {"int32", FieldKind::int32},
    {"uint32", FieldKind::uint32},   {"int64", FieldKind::int64},      {"uint64", FieldKind::uint64},
    {"float32", FieldKind::float32}, {"float64", FieldKind::float64},  {"string", FieldKind::string},
    {"time", FieldKind::time},       {"duration", FieldKind::duration}};

class DefinitionParser {
  public:
    DefinitionParser(std::string_view type, std::string_view text, MessageDialect dialect)
        : dialect_(dialect) {
        if (text.size() > longest_definition) throw UnknownMessage("its definition has more than a megabyte");
        divide(short_type(type), text);
    }

    MessageDefinition parse(std::string_view type) {
        type_index(short_type(type), "", 0);
        return std::move(definition_);
    }

  private:
    // The texts of the type itself and of those it uses, by name.
    void divide(const std::string& type, std::string_view text) {
        std::string name = type;
        std::size_t begin = 0;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            const std::string_view line = trimmed(text.substr(at, end - at));
            const std::size_t next = std::min(end + 1, text.size());
            if (line.size() >= 8 && line.find_first_not_of("=\r") == std::string_view::npos) {
                add_text(name, text.substr(begin, at - begin));
                name.clear();
                begin = next;
            } else if (name.empty() && line.starts_with("MSG:")) {
                std::string_view stated = trimmed(line.substr(4));
                if (stated.ends_with('\r')) stated.remove_suffix(1);
                name = short_type(trimmed(stated));
                begin = next;
            }
            at = next;
        }
        add_text(name, text.substr(begin));
    }

    void add_text(const std::string& name, std::string_view text) {
        const bool is_blank = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
        if (!name.empty() && !(is_blank && texts_.empty())) texts_.try_emplace(name, text);
        if (texts_.size() > max_types) throw UnknownMessage("its definition has too many types");
    }

    // As it is written in a message of `package`, or the only one of that name.
    std::optional<std::pair<std::string, std::string_view>> text_of(const std::string& name,
                                                                    const std::string& package) const {
        std::vector<std::string> names{name};
        if (name == "Header") names.push_back("std_msgs/Header");
        if (name.find('/') == std::string::npos && !package.empty())
            names.insert(names.begin(), package + "/" + name);
        for (const std::string& candidate : names)
            if (const auto found = texts_.find(candidate); found != texts_.end())
                return {{candidate, found->second}};
        for (const std::string& candidate : names)
            if (const auto text = common_definition(candidate, dialect_); !text.empty())
                return {{candidate, text}};
        return std::nullopt;
    }

    int type_index(const std::string& name, const std::string& package, int depth) {
        if (depth > deepest_nesting) throw UnknownMessage("its type is nested too deeply");
        const auto text = text_of(name, package);
        if (!text)
            throw UnknownMessage(fmt::format("the definition of {} is not in the file", printable(name)));
        if (const auto known = indices_.find(text->first); known != indices_.end()) {
            if (known->second < 0)
                throw UnknownMessage(fmt::format("its type {} contains itself", printable(text->first)));
            return known->second;
        }
        indices_[text->first] = -1;
        const auto index = static_cast<int>(definition_.types.size());
        definition_.types.push_back({text->first, {}});
        MessageType type{text->first, {}};
        const std::string own_package =
            text->first.substr(0, std::min(text->first.find('/'), text->first.size()));
        parse_fields(text->second, own_package, type, depth);
        definition_.types[static_cast<std::size_t>(index)] = std::move(type);
        indices_[text->first] = index;
        return index;
    }

    void parse_fields(std::string_view text, const std::string& package, MessageType& type, int depth) {
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            std::string_view line = text.substr(at, end - at);
            at = end + 1;
            if (line.ends_with('\r')) line.remove_suffix(1);
            line = trimmed(line.substr(0, line.find('#')));
            const std::size_t blank = line.find_first_of(" \t");
            if (line.empty() || blank == std::string_view::npos) continue;
            const std::string_view type_text = line.substr(0, blank);
            const std::string_view rest = trimmed(line.substr(blank));
            const std::string_view name = rest.substr(0, rest.find_first_of(" \t="));
            const std::string_view after = trimmed(rest.substr(name.size()));
            if (after.starts_with('=')) continue;  // a constant; anything else is a default value
            add_field(type_text, name, package, type, depth);
        }
        // Where a type has no field, DDS sends a byte all the same.
        if (type.fields.empty() && dialect_ == MessageDialect::ros2)
            type.fields.push_back({"structure_needs_at_least_one_member", FieldKind::uint8});
        for (const MessageField& field : type.fields) {
            type.min_bytes += min_bytes(field);
            type.fields_in_all += 1 + (field.kind == FieldKind::message ? of(field).fields_in_all : 0);
        }
        if (type.fields_in_all > max_fields) throw UnknownMessage("it has too many fields");
    }

    void add_field(std::string_view type_text, std::string_view name, const std::string& package,
                   MessageType& type, int depth) {
        MessageField field{std::string(name)};
        if (name.size() > LogLimits::name_bytes || type.fields.size() >= LogLimits::columns)
            throw UnknownMessage("its definition has too many or too long names");
        if (const std::size_t bracket = type_text.find('['); bracket != std::string_view::npos) {
            const std::string_view count = type_text.substr(bracket + 1, type_text.size() - bracket - 2);
            type_text = type_text.substr(0, bracket);
            field.shape = FieldShape::sequence;
            if (!count.empty() && !count.starts_with("<=")) {
                field.shape = FieldShape::fixed_array;
                const auto [end, error] =
                    std::from_chars(count.data(), count.data() + count.size(), field.count);
                if (error != std::errc() || end != count.data() + count.size() ||
                    field.count > LogLimits::message_bytes)
                    throw UnknownMessage(fmt::format("its array {} has no sensible length", printable(name)));
            }
        }
        type_text = type_text.substr(0, type_text.find("<="));
        const auto named = std::find_if(std::begin(named_kinds), std::end(named_kinds),
                                        [&](const NamedKind& entry) { return entry.name == type_text; });
        if (type_text.starts_with("wstring"))
            throw UnknownMessage("a wide string's bytes in it depend on who wrote the file");
        if (named != std::end(named_kinds)) {
            field.kind = named->kind;
        } else if (const std::string own = short_type(type_text);
                   own == "builtin_interfaces/Time" || own == "builtin_interfaces/Duration") {
            field.kind = FieldKind::duration;  // signed seconds in both
        } else {
            field.kind = FieldKind::message;
            field.message = type_index(own, package, depth + 1);
            if (of(field).min_bytes == 0) {
                if (field.shape == FieldShape::one) return;
                throw UnknownMessage("it has an array of empty messages");
            }
        }
        type.fields.push_back(std::move(field));
    }

    std::size_t min_bytes(const MessageField& field) const {
        if (field.shape == FieldShape::sequence || field.kind == FieldKind::string)
            return field.shape == FieldShape::fixed_array ? bounded(4, field.count) : 4;
        return bounded(field.kind == FieldKind::message ? of(field).min_bytes : size_of(field.kind),
                       field.count);
    }

    const MessageType& of(const MessageField& field) const {
        return definition_.types[static_cast<std::size_t>(field.message)];
    }

    static std::size_t bounded(std::size_t one, std::size_t count) {
        if (one * count > LogLimits::message_bytes)
            throw UnknownMessage("its messages are longer than the limit");
        return one * count;
    }

    static std::string printable(std::string_view name) { return std::string(name.substr(0, 80)); }

    MessageDialect dialect_;
    std::map<std::string, std::string_view> texts_;
    std::map<std::string, int> indices_;  ///< -1: being read
    MessageDefinition definition_;
};

}  // namespace

std::string short_type(std::string_view type) {
    const std::size_t first = type.find('/'), last = type.rfind('/');
    if (first == last) return std::string(type);
    return fmt::format("{}/{}", type.substr(0, first), type.substr(last + 1));
}

std::size_t size_of(FieldKind kind) {
    switch (kind) {
        case FieldKind::boolean:
        case FieldKind::int8:
        case FieldKind::uint8:
            return 1;
        case FieldKind::int16:
        case FieldKind::uint16:
            return 2;
        case FieldKind::int32:
        case FieldKind::uint32:
        case FieldKind::float32:
            return 4;
        case FieldKind::int64:
        case FieldKind::uint64:
        case FieldKind::float64:
        case FieldKind::time:
        case FieldKind::duration:
            return 8;
        case FieldKind::string:
        case FieldKind::message:
            return 0;
    }
    return 0;
}

MessageDefinition parse_definition(std::string_view type, std::string_view text, MessageDialect dialect) {
    return DefinitionParser(type, text, dialect).parse(type);
}

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
