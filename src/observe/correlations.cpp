#include "observe/checks.hpp"

#include <carom/observers.hpp>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// Takes off whole periods, so that a body that left through a periodic face has moved on and not back.
double short_way(double d, double low, double high, const Face& face) {
    return face.kind == FaceKind::periodic ? d - (high - low) * std::round(d / (high - low)) : d;
}

Vec3 short_way(const Vec3& d, const std::optional<Box>& box) {
    if (!box) return d;
    return {short_way(d.x, box->min.x, box->max.x, box->faces[0]),
            short_way(d.y, box->min.y, box->max.y, box->faces[2]),
            short_way(d.z, box->min.z, box->max.z, box->faces[4])};
}

} // namespace

Correlations::Correlations(std::size_t most_lag, std::size_t origin_every)
    : origin_every_(origin_every), most_origins_(origin_every > 0 ? most_lag / origin_every + 1 : 0) {
    observe::check_count("most_lag", most_lag);
    observe::check_count("origin_every", origin_every);
    time_.resize(most_lag + 1);
    displacement_.resize(most_lag + 1);
    velocity_.resize(most_lag + 1);
}

void Correlations::observe(const Sample& sample) {
    const std::size_t bodies = sample.position.size();
    const auto is_of_others = [bodies](const Origin& origin) {
        return origin.position.size() != bodies || origin.velocity.size() != bodies;
    };
    if (seen_ > 0 &&
        (last_.size() != bodies || unwrapped_.size() != bodies || std::ranges::any_of(origins_, is_of_others))) {
        throw Error(ErrorCode::size_mismatch, "sample",
                    "must have as many bodies as before, " + std::to_string(last_.size()) + ", got " +
                        std::to_string(sample.position.size()));
    }
    follow(sample);
    if (seen_ % origin_every_ == 0) {
        const std::size_t place = seen_ / origin_every_ % most_origins_;
        if (place == origins_.size()) origins_.emplace_back();
        origins_.at(place) = {seen_, sample.time, unwrapped_, sample.velocity};
    }
    for (const Origin& origin : origins_) {
        if (seen_ - origin.sample < time_.size()) compare(origin, sample);
    }
    ++seen_;
}

/// Adds to each body's way what it has moved since the last sample.
void Correlations::follow(const Sample& sample) {
    if (seen_ == 0) {
        unwrapped_ = sample.position;
    } else {
        for (std::size_t i = 0; i < last_.size(); ++i) {
            unwrapped_[i] += short_way(sample.position[i] - last_[i], sample.box);
        }
    }
    last_ = sample.position;
}

void Correlations::compare(const Origin& origin, const Sample& sample) {
    double bodies = 0;
    double displacement = 0;
    double velocity = 0;
    for (std::size_t i = 0; i < unwrapped_.size(); ++i) {
        if (sample.mass[i] == infinite_mass) continue;
        ++bodies;
        displacement += length_squared(unwrapped_[i] - origin.position[i]);
        velocity += dot(sample.velocity[i], origin.velocity[i]);
    }
    if (bodies == 0) return;
    const std::size_t lag = seen_ - origin.sample;
    time_[lag].add(sample.time - origin.time);
    displacement_[lag].add(displacement / bodies);
    velocity_[lag].add(velocity / bodies);
}

} // namespace carom
