#include "viewer/render/matrix.hpp"

#include <cmath>
#include <cstddef>

namespace carom::viewer {

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
    Matrix4 product{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
        }
    }
    return product;
}

Matrix4 look_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up) {
    const Vec3f back = unit(eye - target);
    // Whoever looks straight up or down needs another direction to be upright.
    Vec3f right = cross(up, back);
    if (length(right) < 1e-6F * length(up)) right = cross(Vec3f{0, 1, 0}, back);
    if (length(right) < 1e-6F) right = cross(Vec3f{1, 0, 0}, back);
    right = unit(right);
    const Vec3f above = cross(back, right);
    return {right.x, above.x, back.x, 0, right.y,          above.y,          back.y,          0,
            right.z, above.z, back.z, 0, -dot(right, eye), -dot(above, eye), -dot(back, eye), 1};
}

Matrix4 perspective(float field_of_view, float aspect, float near) {
    const float scale = 1 / std::tan(field_of_view / 2);
    Matrix4 matrix{};
    matrix[0] = scale / aspect;
    matrix[5] = scale;
    matrix[11] = -1;
    matrix[14] = near;
    return matrix;
}

Matrix4 orthographic(float radius) {
    Matrix4 matrix{};
    matrix[0] = 1 / radius;
    matrix[5] = 1 / radius;
    matrix[10] = 0.5F / radius;
    matrix[14] = 0.5F;
    matrix[15] = 1;
    return matrix;
}

} // namespace carom::viewer
