/// \file
/// Makes the drawing of a moment: bodies packed for the graphics card, region, obstacles, trails, forces
/// and attractors.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/stage/bounds.hpp"
#include "viewer/stage/moment.hpp"
#include "viewer/stage/obstacle_shapes.hpp"

#include <carom/region.hpp>

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace carom::viewer {

/// `moment` at `time`, relative to `origin`: all that is done for each body in each frame. With a `highlight`, that
/// body glows.
void pack(const Moment& moment, double time, const Vec3& origin, std::optional<BodyId> highlight,
          std::vector<PackedBody>& bodies);

class Stage {
public:
    Stage() = default; ///< without obstacles
    explicit Stage(std::span<const Obstacle> obstacles) : obstacles_(obstacles) {}

    /// What a camera should see of `moment`.
    [[nodiscard]] Ball to_see(const Moment& moment) const;

    /// The drawing of `moment` at `time` (s, in its step), valid until the next call.
    const Drawing& draw(const Moment& moment, double time, const Camera& camera);

    /// Notes for trails where bodies are at `time`; draw() does it too.
    void remember_trails(const Moment& moment, double time);
    /// s of the world's time that trails reach back; 0: none.
    void set_trails(double seconds) { trail_seconds_ = seconds; }
    /// One body glows, and has a trail whether others have one or not.
    void set_highlight(std::optional<BodyId> body);
    /// What belongs to another time is forgotten: the world was set back, or is another one.
    void restart();
    [[nodiscard]] Drawing& settings() { return drawing_; }

private:
    void follow_bodies(const Moment& moment);
    void draw_region(const Region& region, const Ball& bodies);
    void draw_obstacles(double time);
    void draw_box(const Box& box);
    void draw_plane(const Plane& plane, const Ball& bodies);
    void draw_shell(const Shell& shell);
    void draw_attractors(const Moment& moment);
    void draw_forces(const Moment& moment, double time);
    [[nodiscard]] double trail_seconds() const;
    void forget_trails();
    void choose_trail_bodies(const Moment& moment);
    void draw_trails(double time, const Vec3& periods);
    void add_outline(const Vec3& from, const Vec3& to, const Colour& colour);
    [[nodiscard]] Vec3f local(const Vec3& point) const { return narrow(point - drawing_.origin); }

    /// Where the bodies that have trails were at one time.
    struct TrailPoint {
        double time; ///< s
        std::vector<Vec3> position;
    };

    ObstacleShapes obstacles_;
    Drawing drawing_;
    std::vector<PackedBody> packed_;
    std::optional<Ball> bodies_; ///< follows them slowly, so that shadows and haze do not jump
    double trail_seconds_ = 0;
    std::vector<BodyId> trail_bodies_;
    std::deque<TrailPoint> trails_;
    std::optional<BodyId> highlight_;
};

} // namespace carom::viewer
