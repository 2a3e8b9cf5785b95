/// \file
/// An opened scene: its simulation, the clock it is shown by, its stage and its camera.
#pragma once

#include "viewer/stage/stage.hpp"
#include "viewer/window/camera_rig.hpp"
#include "viewer/window/picking.hpp"
#include "viewer/window/simulation.hpp"

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace carom::viewer {

/// What a shot is.
struct Projectile {
    double radius = 1; ///< m
    double mass = 1;   ///< kg
    double speed = 10; ///< m/s
};

class Session {
public:
    /// Opens what load_subject() does. Throws what it throws.
    explicit Session(const std::filesystem::path& file);

    /// \name Time
    /// @{

    /// So many seconds of the wall clock have passed. `wait`: until the simulation is there, so that what is shown does
    /// not depend on how fast it is.
    void advance(double seconds, bool wait);
    void set_paused(bool paused) { paused_ = paused; }
    [[nodiscard]] bool paused() const { return paused_; }
    void step();
    void step_back();
    void restart();
    [[nodiscard]] double time() const { return clock_; } ///< s, of what is shown
    /// s of the world in a second of the wall clock, as asked for and as it was lately.
    double time_scale = 1;
    [[nodiscard]] double time_scale_reached() const { return reached_; }
    /// s of the world by which what is shown is behind what was asked for, since the last pause.
    [[nodiscard]] double lag() const { return lag_; }
    /// @}

    /// \name What is seen
    /// @{

    const Drawing& draw();
    [[nodiscard]] Stage& stage() { return stage_; }
    [[nodiscard]] CameraRig& rig() { return rig_; }
    void go_home() { rig_.set_camera(home_); }
    /// m: the size of what is there to see.
    [[nodiscard]] double scale() const { return ball_.radius; }
    void pick_at(const Place& place);
    void pick(std::optional<BodyId> id);
    [[nodiscard]] std::optional<BodyId> picked() const { return picked_; }
    void colour_by(scene::ColourBy by);
    [[nodiscard]] scene::ColourBy colour_by() const { return colour_by_; }
    void show_forces(bool forces);
    [[nodiscard]] bool forces() const { return forces_; }
    void set_trails(double seconds);
    [[nodiscard]] double trails() const { return trails_; }
    /// @}

    /// \name What is heard
    /// @{
    /// Impacts are to be heard, or are not.
    void hear(bool wanted);
    [[nodiscard]] std::vector<TimedStrike> take_strikes() { return simulation_->take_strikes(); }
    /// Those that suit the scene as it begins, seen from where the camera began.
    [[nodiscard]] sound::SoundSettings sound_settings() const;
    /// Ears at the camera; they move with the body that it follows.
    [[nodiscard]] sound::Listener listener() const;
    /// @}

    /// \name What the user changes in the world
    /// @{
    void set_gravity(const Vec3& gravity);
    void set_drag(const Drag& drag);
    void set_restitution(double restitution);
    void shoot(const Place& place);
    Vec3 gravity{};         ///< m/s^2, as it is or will be
    Drag drag{};            ///< likewise
    double restitution = 1; ///< that of the first body, and of all once it was set
    Projectile projectile{};
    /// @}

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] Status status() const { return simulation_->status(); }
    [[nodiscard]] std::shared_ptr<const Moment> moment() const { return moment_; }
    [[nodiscard]] const std::deque<PlotRow>& plots() const { return rows_; }

private:
    void find_home(const scene::CameraSpec& spec);
    void go_on(double seconds, bool wait);
    void show_now();
    void take_plots();

    std::filesystem::path file_;
    std::string title_;
    std::unique_ptr<Simulation> simulation_;
    Stage stage_;
    CameraRig rig_;
    Camera home_;
    Ball ball_;
    std::shared_ptr<const Moment> moment_;
    std::deque<PlotRow> rows_;
    double clock_ = 0;
    double lag_ = 0;
    double reached_ = 0;
    std::uint64_t era_ = 0; ///< of the moments to show: earlier ones are from before a restart
    bool paused_ = false;
    std::optional<BodyId> picked_;
    scene::ColourBy colour_by_ = scene::ColourBy::material;
    bool forces_ = false;
    bool hears_ = false;
    double trails_ = 0;
};

} // namespace carom::viewer
