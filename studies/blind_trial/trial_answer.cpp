#include "capstan/blind_trial/trial_answer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "capstan/cable/invalid_input.h"
#include "capstan/effects/known_causes.h"
#include "capstan/platform/files.h"
#include "capstan/recording/json_object.h"

namespace capstan::gap_trial {

namespace {

using nlohmann::json;

json in_json(const CaseAnswer& answer, const std::string& seal) {
    json text = {{"case", answer.name},
                 {"labels_sha256", seal},
                 {"ranked", json::array()},
                 {"named", answer.named},
                 {"component", answer.component},
                 {"end", answer.end},
                 {"s_m", answer.position_m ? json(*answer.position_m) : json(nullptr)},
                 {"channels", json::array()}};
    for (const AnsweredEffect& each : answer.ranked) {
        json entry = {{"effect", each.effect}, {"probability", each.probability}};
        if (each.present) entry["present"] = *each.present;
        if (!each.varies.empty()) entry["varies"] = each.varies;
        text["ranked"].push_back(std::move(entry));
    }
    for (const ChannelRms& each : answer.channels) {
        json entry = {{"channel", each.channel}, {"rms_before", each.before}, {"rms_after", each.after}};
        if (each.held_out) entry["rms_held_out"] = *each.held_out;
        text["channels"].push_back(std::move(entry));
    }
    return text;
}

std::optional<double> optional_number(const json& entry, const char* key) {
    if (!entry.contains(key) || entry.at(key).is_null()) return std::nullopt;
    return entry.at(key).get<double>();
}

// `present` and `varies` where a diagnosis states them.
template <class Ranked>
AnsweredEffect answered(const Ranked& each) {
    AnsweredEffect effect{each.effect, each.probability};
    if constexpr (requires { each.present; }) effect.present = each.present;
    if constexpr (requires { each.varies; }) effect.varies = each.varies;
    return effect;
}

}  // namespace

CaseAnswer answer_of(const std::string& name, const gap::Diagnosis& diagnosis) {
    CaseAnswer answer;
    answer.name = name;
    for (const gap::RankedEffect& each : gap::in_answered_names(diagnosis.ranked))
        answer.ranked.push_back(answered(each));
    for (const gap::FittedCause& cause : diagnosis.causes)
        answer.named.push_back(answered_name(cause.effect));
    answer.component = diagnosis.component;
    answer.end = diagnosis.end;
    answer.position_m = diagnosis.position_m;
    for (const gap::ChannelGap& channel : diagnosis.gap.channels)
        answer.channels.push_back(
            {channel.channel, channel.before_rms, channel.after_rms, channel.held_out_rms});
    return answer;
}

void write_answer(const std::filesystem::path& path, const CaseAnswer& answer, const std::string& seal) {
    write_file(path, in_json(answer, seal).dump(1) + "\n");
}

CaseAnswer read_answer(const std::filesystem::path& path, const std::string& seal) {
    const json text = read_json_file(path);
    try {
        const std::string given_under = text.at("labels_sha256");
        if (given_under != seal)
            throw InvalidInput(
                {fmt::format("{}: was given for labels that hash to {}, not to {}; remove it, or "
                             "score it with its own labels",
                             path.string(), given_under, seal)});
        CaseAnswer answer;
        answer.name = text.at("case");
        for (const json& each : text.at("ranked"))
            answer.ranked.push_back({each.at("effect"), each.at("probability"),
                                     optional_number(each, "present"), each.value("varies", "")});
        answer.named = text.at("named").get<std::vector<std::string>>();
        answer.component = text.at("component");
        answer.end = text.at("end");
        if (!text.at("s_m").is_null()) answer.position_m = text.at("s_m").get<double>();
        for (const json& each : text.at("channels"))
            answer.channels.push_back({each.at("channel"), each.at("rms_before"), each.at("rms_after"),
                                       optional_number(each, "rms_held_out")});
        return answer;
    } catch (const json::exception& problem) {
        throw InvalidInput({fmt::format("{}: not an answer of a trial: {}; remove it and run the trial again",
                                        path.string(), problem.what())});
    }
}

}  // namespace capstan::gap_trial
