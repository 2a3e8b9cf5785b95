/// \file
/// Hashes of what worlds tell, bit by bit: 0 and -0 differ.
#pragma once

#include <carom/events.hpp>

#include <bit>
#include <cstdint>
#include <span>

namespace carom::test {

/// FNV-1a over whole numbers instead of bytes.
class Digest {
public:
    void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100000001b3U; }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(const Vec3& vector) {
        add(vector.x);
        add(vector.y);
        add(vector.z);
    }
    void add(BodyId id) {
        add(std::uint64_t{id.slot});
        add(std::uint64_t{id.generation});
    }
    void add(const Impact& impact) {
        add(impact.time);
        add(impact.offset);
        add(impact.a);
        add(impact.b);
        add(static_cast<std::uint64_t>(impact.face));
        add(impact.position);
        add(impact.normal);
        add(impact.impulse);
        add(impact.approach_speed);
        add(impact.energy_lost);
    }
    void add(std::span<const Impact> impacts) {
        for (const Impact& impact : impacts) add(impact);
    }
    void add(const Ledger& ledger) {
        add(ledger.impacts);
        add(ledger.face_impacts);
        add(ledger.lost_to_restitution);
        add(ledger.lost_to_friction);
        add(ledger.lost_to_drag);
        add(ledger.prescribed_work);
        add(ledger.outer_impulse);
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

} // namespace carom::test
