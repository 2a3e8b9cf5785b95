#include "scene/scene.hpp"

namespace carom::scene {

namespace {

template <class T>
void append_column(std::vector<T>& column, const std::vector<T>& more) {
    column.insert(column.end(), more.begin(), more.end());
}

} // namespace

BodyTable BodyTable::of(std::size_t count) {
    const Body standard;
    BodyTable table;
    table.position.assign(count, standard.position);
    table.velocity.assign(count, standard.velocity);
    table.mass.assign(count, standard.mass);
    table.radius.assign(count, standard.radius);
    table.growth.assign(count, standard.growth);
    table.restitution.assign(count, standard.restitution);
    table.friction.assign(count, standard.friction);
    table.material.assign(count, standard.material);
    return table;
}

void BodyTable::append(const BodyTable& other) {
    append_column(position, other.position);
    append_column(velocity, other.velocity);
    append_column(mass, other.mass);
    append_column(radius, other.radius);
    append_column(growth, other.growth);
    append_column(restitution, other.restitution);
    append_column(friction, other.friction);
    append_column(material, other.material);
}

ConstBodyColumns BodyTable::columns() const {
    return {.position = position,
            .velocity = velocity,
            .mass = mass,
            .radius = radius,
            .restitution = restitution,
            .friction = friction,
            .material = material,
            .growth = growth};
}

} // namespace carom::scene
