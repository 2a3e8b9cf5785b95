#include "scene/summary.hpp"

#include "scene/digit_groups.hpp"

#include <carom/executor.hpp>

#include <fmt/format.h>

#include <iterator>

namespace carom::scene {

namespace {

std::string grouped(std::uint64_t count) { return group_digits(std::to_string(count), " "); }

/// Bytes in a unit that people read.
std::string memory_text(std::uint64_t bytes) {
    constexpr double mebi = 1024.0 * 1024.0;
    const double size = static_cast<double>(bytes) / mebi;
    return size < 10240 ? fmt::format("{:.0f} MiB", size) : fmt::format("{:.1f} GiB", size / 1024);
}

std::string overlap_text(const std::optional<OverlapReport>& overlap) {
    if (!overlap) return "not searched for";
    std::string text = overlap->largest > 0 ? fmt::format("at most {:.3g} diameters", overlap->largest) : "none";
    if (overlap->touching > 0) {
        text += fmt::format(", {:.3g} on average where bodies touch at the end", overlap->mean);
    }
    if (overlap->bodies_outside > 0) text += fmt::format("; {} bodies outside", grouped(overlap->bodies_outside));
    return text;
}

} // namespace

const char* name_of(Precision precision) { return precision == Precision::single_precision ? "single" : "double"; }

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

double ratio(double value, double by) { return by > 0 ? value / by : 0; }

nlohmann::ordered_json to_json(const Summary& s) {
    nlohmann::ordered_json json;
    json["bodies"] = s.bodies;
    json["steps"] = s.steps;
    json["dt"] = s.dt;
    json["threads"] = s.threads;
    json["precision"] = name_of(s.precision);
    json["simd"] = simd_target();
    json["wall_seconds"] = s.wall_seconds;
    json["ns_per_body_step"] = s.ns_per_body_step;
    json["ns_per_body_step_min"] = s.ns_per_body_step_min;
    json["impacts"] = s.pair_impacts + s.face_impacts;
    json["pair_impacts"] = s.pair_impacts;
    json["face_impacts"] = s.face_impacts;
    json["impacts_per_second"] = s.impacts_per_second;
    json["contacts"] = s.contacts;
    json["energy_initial"] = s.start.total();
    json["energy_final"] = s.end.total();
    json["energy_lost"] = s.end.lost() - s.start.lost();
    json["energy_balance"] = energy_balance(s.start, s.end);
    json["energy_drift"] = energy_drift(s.start, s.end);
    json["kinetic_initial"] = s.start.kinetic;
    json["kinetic_final"] = s.end.kinetic;
    json["momentum_drift"] = momentum_drift(s.start, s.end);
    for (const char* key : {"max_overlap", "mean_overlap", "bodies_outside"}) json[key] = nullptr;
    if (s.overlap) {
        json["max_overlap"] = s.overlap->largest;
        json["mean_overlap"] = s.overlap->mean;
        json["bodies_outside"] = s.overlap->bodies_outside;
    }
    json["peak_rss_bytes"] = s.peak_rss_bytes;
    json["bytes_per_body"] = s.bytes_per_body;
    json["hash"] = hash_text(s.hash);
    return json;
}

std::string to_text(const Summary& s) {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "  bodies    {}, {} precision, {} thread{}\n", grouped(s.bodies), name_of(s.precision),
                   s.threads, s.threads == 1 ? "" : "s");
    fmt::format_to(out, "  steps     {} of {:.6g} s in {:.3g} s: {:.4g} ns per body and step\n", grouped(s.steps), s.dt,
                   s.wall_seconds, s.ns_per_body_step);
    fmt::format_to(out, "  impacts   {} between bodies, {} with walls; {:.3g} a second; {} resting contacts\n",
                   grouped(s.pair_impacts), grouped(s.face_impacts), s.impacts_per_second, grouped(s.contacts));
    fmt::format_to(out, "  energy    {:.6g} J, then {:.6g} J and {:.6g} J booked as lost: balance {:.2e}\n",
                   s.start.total(), s.end.total(), s.end.lost() - s.start.lost(), energy_balance(s.start, s.end));
    fmt::format_to(out, "  momentum  drift {:.2e}\n", momentum_drift(s.start, s.end));
    fmt::format_to(out, "  overlap   {}\n", overlap_text(s.overlap));
    fmt::format_to(out, "  memory    {} at most, {:.0f} bytes per body\n", memory_text(s.peak_rss_bytes),
                   s.bytes_per_body);
    fmt::format_to(out, "  hash      {}\n", hash_text(s.hash));
    return fmt::to_string(text);
}

std::string file_text(const nlohmann::ordered_json& json) {
    // A scene's name is its file's, which need not be UTF-8: JSON gets a replacement character then.
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace carom::scene
