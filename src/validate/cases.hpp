/// \file
/// The validation cases. Each group is in a file of its own and lists what is to be computed; tasks are independent of
/// each other and may run at the same time.
#pragma once

#include "validate/findings.hpp"

#include <functional>
#include <string_view>
#include <vector>

namespace carom::validate {

enum class Extent : std::uint8_t { quick, full };

/// One computation; its world runs in one thread.
struct Task {
    double cost = 0; ///< about how many seconds it takes
    std::function<Findings()> run;
};

/// A group of cases, as `--only` names it.
struct Group {
    std::string_view name;
    std::vector<Task> (*tasks)(Extent extent);
};

/// In the order of the table.
std::span<const Group> groups();

std::vector<Task> two_body_tasks(Extent extent);
std::vector<Task> bouncing_tasks(Extent extent);
std::vector<Task> drag_tasks(Extent extent);
std::vector<Task> chain_tasks(Extent extent);
std::vector<Task> pi_tasks(Extent extent);
std::vector<Task> fluid_tasks(Extent extent);
std::vector<Task> relaxation_tasks(Extent extent);
std::vector<Task> cooling_tasks(Extent extent);
std::vector<Task> diffusion_tasks(Extent extent);
std::vector<Task> gravity_tasks(Extent extent);
std::vector<Task> tunnelling_tasks(Extent extent);
std::vector<Task> symmetry_tasks(Extent extent);
std::vector<Task> long_run_tasks(Extent extent);
std::vector<Task> compression_tasks(Extent extent);
std::vector<Task> restitution_tasks(Extent extent);
std::vector<Task> packing_tasks(Extent extent);

/// What of carom's physics no case tests, and why.
std::span<const std::string_view> not_tested();

} // namespace carom::validate
