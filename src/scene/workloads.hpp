/// \file
/// The workloads of `carom bench`: defined once, with fixed seeds, for benchmarks, tests and comparisons alike.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace carom::scene {

/// A scene to measure with. Scene::run holds dt and the steps to time.
struct Workload {
    Scene scene;
    std::uint64_t warm_up = 0; ///< steps before the timed ones
};

/// Names and one line about each, in the order of the documentation.
struct WorkloadInfo {
    std::string_view name;
    std::string_view text;
};
std::span<const WorkloadInfo> workload_list();

/// Makes a workload of so many bodies, in [1, default_max_bodies]. Throws SceneError naming what is allowed.
Workload workload(std::string_view name, std::uint64_t bodies, Precision precision = Precision::double_precision);

} // namespace carom::scene
