#include "world/engine.hpp"

#include "contact/rest.hpp"
#include "space/checks.hpp"

namespace carom::core {

namespace {

double checked_resolution(const WorldOptions& options) {
    if (options.resolution == 0) {
        const bool is_single = options.precision == Precision::single_precision;
        return std::ldexp(1.0, is_single ? -20 : -40);
    }
    check_positive(options.resolution, "resolution");
    int exponent = 0;
    if (std::frexp(options.resolution, &exponent) != 0.5) {
        throw Error(ErrorCode::out_of_range, "resolution", "must be a power of two, got " + shown(options.resolution));
    }
    // The resolution is 2^(exponent - 1).
    if (exponent - 1 < smallest_resolution_exponent || exponent - 1 > largest_resolution_exponent) {
        throw Error(ErrorCode::out_of_range, "resolution",
                    "must lie in [2^-100, 2^40] m, got " + shown(options.resolution));
    }
    return options.resolution;
}

/// A whole number of metres, other than 0 and inside the world, in units.
std::int64_t whole_units(std::int64_t metres, const Resolution& resolution, std::size_t axis) {
    if (resolution.metres <= 1) return metres * static_cast<std::int64_t>(resolution.per_metre);
    if (metres % static_cast<std::int64_t>(resolution.metres) != 0) {
        throw Error(ErrorCode::out_of_range, "origin", "must be a multiple of the resolution", axis);
    }
    return metres / static_cast<std::int64_t>(resolution.metres);
}

void check_materials(const std::vector<Material>& materials) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        check_law(materials[i].restitution, "materials.restitution", i);
        const auto is_same = [&](const Material& other) { return other.key == materials[i].key; };
        if (!std::any_of(materials.begin(), materials.begin() + static_cast<std::ptrdiff_t>(i), is_same)) continue;
        throw Error(ErrorCode::out_of_range, "materials.key",
                    "must differ from those before, got " + std::to_string(materials[i].key), i);
    }
}

void check_rules(const std::vector<MaterialRule>& rules) {
    for (std::size_t i = 0; i < rules.size(); ++i) {
        if (rules[i].law) check_law(*rules[i].law, "material_rules.law", i);
        check_fraction(rules[i].restitution, "material_rules.restitution", i);
        check_not_negative(rules[i].friction, "material_rules.friction", i);
        const auto is_same = [&](const MaterialRule& other) {
            return std::minmax(other.a, other.b) == std::minmax(rules[i].a, rules[i].b);
        };
        if (std::none_of(rules.begin(), rules.begin() + static_cast<std::ptrdiff_t>(i), is_same)) continue;
        throw Error(ErrorCode::out_of_range, "material_rules",
                    "must have each pair once, got materials " + std::to_string(rules[i].a) + " and " +
                        std::to_string(rules[i].b) + " again",
                    i);
    }
}

void check_min_windows(std::uint32_t min_windows) {
    if (min_windows >= 1 && min_windows <= most_windows) return;
    throw Error(ErrorCode::out_of_range, "min_windows",
                "must lie in [1, " + std::to_string(most_windows) + "], got " + std::to_string(min_windows));
}

} // namespace

void check_drag(const Drag& drag) {
    check_not_negative(drag.linear, "drag.linear");
    check_not_negative(drag.quadratic, "drag.quadratic");
}

Int3 origin_units(const std::array<std::int64_t, 3>& origin, const Resolution& resolution) {
    Int3 units;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double distance = std::abs(static_cast<double>(origin[axis]));
        if (!(distance * resolution.per_metre < static_cast<double>(world_edge))) {
            throw Error(ErrorCode::out_of_world, "origin", "outside the world; " + remedy_for(distance), axis);
        }
        if (origin[axis] != 0) component(units, static_cast<int>(axis)) = whole_units(origin[axis], resolution, axis);
    }
    return units;
}

Setting checked_setting(WorldOptions options) {
    Setting setting;
    if (options.precision != Precision::single_precision && options.precision != Precision::double_precision) {
        throw Error(ErrorCode::out_of_range, "precision", "must be single or double");
    }
    const double resolution = checked_resolution(options);
    setting.resolution = {resolution, 1 / resolution};
    setting.origin = setting.first_origin = origin_units(options.origin, setting.resolution);
    check_finite(options.gravity, "gravity");
    check_drag(options.drag);
    check_materials(options.materials);
    check_rules(options.material_rules);
    check_positive(options.rest_time, "rest_time");
    check_positive(options.collapse_time, "collapse_time");
    check_not_negative(options.least_recorded_impulse, "least_recorded_impulse");
    check_min_windows(options.min_windows);
    setting.options = std::move(options);
    return setting;
}

template <class Real>
Engine<Real>::Engine(Setting setting, std::uint16_t world_tag)
    : setting_(std::move(setting)), world_tag_(world_tag), pile_(state_), serial_(state_), islands_(state_, serial_),
      placement_(state_) {
    const WorldOptions& options = setting_.options;
    state_.resolution = setting_.resolution;
    state_.bounds = Bounds(options.region, options.obstacles, setting_.resolution, setting_.first_origin);
    state_.laws.gravity = options.gravity;
    state_.laws.rest_time = options.rest_time;
    state_.laws.sleeping = options.sleeping;
    state_.laws.quick_time = options.collapse_time;
    set_contact_time(state_.laws, state_.resolution);
    state_.laws.materials = options.materials;
    state_.laws.rules = options.material_rules;
    state_.bodies.interpolating = options.interpolation;
    set_executor(make_default_executor(options.threads));
}

template <class Real>
Engine<Real>::Engine(const Engine& other)
    : setting_(other.setting_), world_tag_(other.world_tag_), state_(other.state_), attractors_(other.attractors_),
      attractor_places_(other.attractor_places_), clock_(other.clock_), ledger_(other.ledger_), report_(other.report_),
      contact_changes_(other.contact_changes_), impacts_(other.impacts_), pile_(state_), serial_(state_),
      islands_(state_, serial_), placement_(state_), last_start_(other.last_start_), last_step_(other.last_step_) {
    set_executor(other.executor_);
}

template <class Real>
void Engine<Real>::set_gravity(const Vec3& gravity) {
    check_finite(gravity, "gravity");
    setting_.options.gravity = state_.laws.gravity = gravity;
    set_contact_time(state_.laws, state_.resolution);
    wake_all(state_.bodies);
    drop_contact_list(state_.bodies);
    islands_.vicinity().forget();
}

template <class Real>
void Engine<Real>::set_drag(const Drag& drag) {
    check_drag(drag);
    setting_.options.drag = drag;
}

template <class Real>
void Engine<Real>::set_attractors(std::span<const Attractor> attractors) {
    std::vector<Int3> places(attractors.size());
    for (std::size_t i = 0; i < attractors.size(); ++i) {
        const Attractor& attractor = attractors[i];
        check_finite(attractor.strength, "attractor.strength", i);
        check_not_negative(attractor.softening, "attractor.softening", i);
        if (!attractor.body.is_set()) {
            places[i] =
                position_units(attractor.position, setting_.resolution, setting_.origin, "attractor.position", i);
        } else if (!contains(attractor.body)) {
            throw Error(ErrorCode::unknown_body, "attractor.body", "there is no such body in this world", i);
        }
    }
    attractors_.assign(attractors.begin(), attractors.end());
    attractor_places_ = std::move(places);
    if (!attractors_.empty()) wake_all(state_.bodies);
}

template <class Real>
void Engine<Real>::set_face_motion(std::int32_t face, const FaceMotion& motion) {
    const auto& walls = state_.bounds.walls();
    const auto found =
        std::find_if(walls.begin(), walls.end(), [face](const Bounds::Wall& wall) { return wall.face == face; });
    if (found == walls.end() || state_.bounds.shape() == Bounds::Shape::shell) {
        throw Error(ErrorCode::out_of_range, "face",
                    "must be a reflecting face of a box, or a plane, got " + std::to_string(face));
    }
    const auto wall = static_cast<std::uint32_t>(found - walls.begin());
    state_.bounds.set_motion(wall, motion, "motion");
    Region& region = setting_.options.region;
    if (auto* box = std::get_if<Box>(&region)) box->faces.at(static_cast<std::size_t>(face)).motion = motion;
    if (auto* planes = std::get_if<std::vector<Plane>>(&region)) {
        planes->at(static_cast<std::size_t>(face)).motion = motion;
    }
    release_from(state_.bodies, Support::wall_bit | wall);
    wake_all(state_.bodies);
    drop_contact_list(state_.bodies);
    islands_.vicinity().forget();
}

template <class Real>
Region Engine<Real>::region() const {
    Region region = setting_.options.region;
    const Vec3 shift = to_metres(setting_.first_origin - setting_.origin, setting_.resolution);
    if (auto* const shell = std::get_if<Shell>(&region)) shell->centre += shift;
    if (auto* const planes = std::get_if<std::vector<Plane>>(&region)) {
        for (Plane& plane : *planes) plane.point += shift;
        for (const Bounds::Wall& wall : state_.bounds.walls()) {
            Plane& plane = planes->at(static_cast<std::size_t>(wall.face));
            plane.point += wall.normal * -wall.offset;
            plane.motion.phase = wall.phase.value();
        }
    }
    if (auto* const box = std::get_if<Box>(&region)) {
        box->min += shift;
        box->max += shift;
        for (const Bounds::Wall& wall : state_.bounds.walls()) {
            (wall.face % 2 == 0 ? box->min : box->max) += wall.normal * -wall.offset;
            box->faces.at(static_cast<std::size_t>(wall.face)).motion.phase = wall.phase.value();
        }
    }
    return region;
}

template <class Real>
void Engine<Real>::set_origin(const std::array<std::int64_t, 3>& origin) {
    const Int3 units = origin_units(origin, setting_.resolution);
    setting_.options.origin = origin;
    setting_.origin = units;
    for (std::size_t i = 0; i < attractors_.size(); ++i) {
        if (!attractors_[i].body.is_set()) attractors_[i].position = api_position(attractor_places_[i]);
    }
}

template <class Real>
void Engine<Real>::set_recording(bool record_impacts, double least_recorded_impulse) {
    check_not_negative(least_recorded_impulse, "least_recorded_impulse");
    setting_.options.record_impacts = record_impacts;
    setting_.options.least_recorded_impulse = least_recorded_impulse;
}

template <class Real>
void Engine<Real>::set_serial_reference(bool serial_reference) {
    setting_.options.serial_reference = serial_reference;
    // Meanwhile the one that rests does not see where bodies go.
    islands_.vicinity().forget();
}

template <class Real>
void Engine<Real>::set_threads(unsigned threads) {
    set_executor(make_default_executor(threads));
    setting_.options.threads = threads;
}

template <class Real>
void Engine<Real>::set_executor(std::shared_ptr<Executor> executor) {
    if (!executor) throw Error(ErrorCode::out_of_range, "executor", "must not be null");
    executor_ = std::move(executor);
    pile_.use(*executor_);
    islands_.use(executor_);
}

template <class Real>
void Engine<Real>::set_min_windows(std::uint32_t min_windows) {
    check_min_windows(min_windows);
    setting_.options.min_windows = min_windows;
}

template class Engine<float>;
template class Engine<double>;

} // namespace carom::core
