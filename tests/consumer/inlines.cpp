// Inline functions of carom's headers, compiled as a user's compiler does: the linker may take these for the
// library's own, so they must compute the same. tests/CMakeLists.txt looks for fused multiply-adds in them.
#include <carom/carom.hpp>

namespace carom {

template Response<float> respond(const Vector3<float>&, float, Vector3<float>&, float, Vector3<float>&, float, float);
template Response<double> respond(const Vec3&, double, Vec3&, double, Vec3&, double, double);
template double time_to_spheres(const Vec3&, const Vec3&, double, double);
template double time_to_spheres(const Vec3&, const Vec3&, const Vec3&, double, double);
template double time_to_shell_inside(const Vec3&, const Vec3&, const Vec3&, double, double);
template BoxImpact<double> time_to_box_outside(const Vec3&, const Vec3&, const Vec3&, double, const Vec3&, const Vec3&,
                                               double);

} // namespace carom

int main() { return 0; }
