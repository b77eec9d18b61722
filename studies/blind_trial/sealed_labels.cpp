#include "capstan/blind_trial/sealed_labels.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "capstan/cable/invalid_input.h"
#include "capstan/platform/files.h"
#include "capstan/recording/json_object.h"

namespace capstan::gap_trial {

namespace {

using nlohmann::ordered_json;

constexpr const char* labels_name = "labels.json";
constexpr const char* hash_name = "labels.sha256";

TruthGroup group_named(const std::string& name) {
    if (const auto group = truth_group_named(name)) return *group;
    throw std::invalid_argument(fmt::format("no group of cases is called '{}'", name));
}

ordered_json text_or_null(const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

std::string text_of(const ordered_json& json) {
    return json.is_null() ? "" : json.get<std::string>();
}

ordered_json cause_json(const TrueCause& cause) {
    ordered_json json = {
        {"effect", cause.effect},
        {"kind", cause.kind},
        {"component", text_or_null(cause.component)},
        {"end", text_or_null(cause.end)},
        {"s_m", cause.where ? ordered_json({cause.where->from_m, cause.where->to_m}) : ordered_json(nullptr)},
        {"size", {{"name", cause.size_name}, {"value", cause.size}}},
        {"shape", cause.shape},
        {"visibility", cause.visibility},
        {"clearest_channel", cause.clearest_channel}};
    if (!cause.varies.empty()) json["varies"] = cause.varies;
    return json;
}

TrueCause cause_of(const ordered_json& json) {
    TrueCause cause;
    cause.effect = json.at("effect");
    cause.kind = json.at("kind");
    cause.component = text_of(json.at("component"));
    cause.end = text_of(json.at("end"));
    if (const ordered_json& where = json.at("s_m"); !where.is_null())
        cause.where = {where.at(0), where.at(1)};
    cause.size_name = json.at("size").at("name");
    cause.size = json.at("size").at("value");
    cause.shape = json.at("shape").get<std::map<std::string, double>>();
    cause.visibility = json.at("visibility");
    cause.clearest_channel = json.at("clearest_channel");
    cause.varies = json.value("varies", "");
    return cause;
}

ordered_json case_json(const CaseLabel& label) {
    ordered_json json = {
        {"group", truth_group_name(label.group)},
        {"severity", label.severity ? ordered_json(severity_name(*label.severity)) : ordered_json(nullptr)},
        {"bench", label.bench},
        {"protocols", label.protocols},
        {"causes", ordered_json::array()},
        {"true_ratios",
         {{"friction", label.friction_ratio},
          {"stiffness", label.stiffness_ratio},
          {"pretension", label.pretension_ratio}}}};
    for (const TrueCause& cause : label.causes) json["causes"].push_back(cause_json(cause));
    for (const Nuisance& nuisance : label.nuisances)
        json["nuisances"].push_back(
            {{"effect", nuisance.effect}, {"where", nuisance.where}, {"size", nuisance.size}});
    if (!label.conditions.empty()) json["conditions"] = label.conditions;
    return json;
}

CaseLabel case_of(const std::string& name, const ordered_json& json) {
    CaseLabel label;
    label.name = name;
    label.group = group_named(json.at("group"));
    if (!json.at("severity").is_null())
        label.severity = json.at("severity") == "mild" ? Severity::mild : Severity::strong;
    label.bench = json.at("bench");
    label.protocols = json.at("protocols").get<std::vector<std::string>>();
    for (const ordered_json& cause : json.at("causes")) label.causes.push_back(cause_of(cause));
    for (const ordered_json& nuisance : json.value("nuisances", ordered_json::array()))
        label.nuisances.push_back({nuisance.at("effect"), nuisance.at("where"), nuisance.at("size")});
    label.conditions = json.value("conditions", std::vector<std::string>());
    const ordered_json& ratios = json.at("true_ratios");
    label.friction_ratio = ratios.at("friction");
    label.stiffness_ratio = ratios.at("stiffness");
    label.pretension_ratio = ratios.at("pretension");
    return label;
}

}  // namespace

std::string random_salt() {
    std::random_device device;
    std::string salt;
    for (int k = 0; k < 4; ++k) salt += fmt::format("{:08x}", device());
    return salt;
}

std::string sha256(const std::string& bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("libcrypto does not provide SHA-256; is it installed completely?");
    std::string text;
    for (unsigned int k = 0; k < length; ++k) text += fmt::format("{:02x}", digest[k]);
    return text;
}

std::string labels_text(const TrialLabels& labels) {
    ordered_json json = {{"salt", labels.salt}};
    add_options(json, labels.options);
    json["cases"] = ordered_json::object();
    for (const CaseLabel& label : labels.cases) json["cases"][label.name] = case_json(label);
    return json.dump(1) + "\n";
}

TrialLabels read_labels(const std::string& text, const std::string& place) {
    try {
        const ordered_json json = ordered_json::parse(text);
        TrialLabels labels;
        labels.salt = json.at("salt");
        labels.options.seed = json.at("seed");
        const std::string severity = json.at("severity");
        labels.options.severity = severity == "mild"     ? SeverityChoice::mild
                                  : severity == "strong" ? SeverityChoice::strong
                                                         : SeverityChoice::both;
        labels.options.noise_factor = json.at("noise_factor");
        labels.options.length =
            json.at("length") == "standard" ? RecordingLength::standard : RecordingLength::brief;
        labels.options.nominal_error = json.at("nominal_error");
        if (json.value("kind", "benches") == trial_kind_name(TrialKind::rigs))
            labels.options.kind = TrialKind::rigs;
        if (json.contains("visibility"))
            labels.options.visibility = {json.at("visibility").at(0), json.at("visibility").at(1)};
        labels.options.nuisances = json.value("nuisances", false);
        labels.options.mixtures = json.value("mixtures", TrialOptions().mixtures);
        if (json.contains("only")) labels.options.only = group_named(json.at("only"));
        for (const auto& [name, label] : json.at("cases").items())
            labels.cases.push_back(case_of(name, label));
        labels.options.cases = static_cast<int>(labels.cases.size());
        return labels;
    } catch (const std::exception& problem) {
        throw InvalidInput(
            {fmt::format("{}: not the labels of a trial: {}; give the labels.json that gap-trial wrote",
                         place, problem.what())});
    }
}

std::string seal_labels(const std::filesystem::path& folder, const TrialLabels& labels) {
    const std::string text = labels_text(labels);
    std::string hash = sha256(text);
    write_file(folder / labels_name, text);
    write_file(folder / hash_name, fmt::format("{}  {}\n", hash, labels_name));
    return hash;
}

TrialLabels unseal_labels(const std::filesystem::path& labels_file, const std::string& expected_hash) {
    const std::string text = read_input_file(labels_file);
    const std::string hash = sha256(text);
    const std::filesystem::path hash_file = labels_file.parent_path() / hash_name;
    if (!std::filesystem::exists(hash_file))
        throw InvalidInput(
            {fmt::format("{}: has no {} beside it, which says what they were before any diagnosis; "
                         "score them in the folder that gap-trial --keep made",
                         labels_file.string(), hash_name)});
    const std::string sealed = read_input_file(hash_file).substr(0, hash.size());
    const std::string printed = expected_hash.empty() ? hash : expected_hash;
    for (const auto& [said, by] :
         {std::pair(sealed, hash_file.string()), std::pair(printed, std::string("what was printed"))}) {
        if (said != hash)
            throw InvalidInput({fmt::format(
                "{}: hashes to {}, but {} says {}: the labels were changed after they were sealed; score with "
                "the file as it was written",
                labels_file.string(), hash, by, said)});
    }
    return read_labels(text, labels_file.string());
}

}  // namespace capstan::gap_trial
