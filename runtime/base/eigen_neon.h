// Eigen's arithmetic on NEON, as it is on SSE2, whose bits are those of every build. Left to itself Eigen adds floats
// two by two, where SSE2 has registers of four alone: x + (y + z) becomes (x + y) + z. The least and the largest of two
// it takes by instructions that order zeros by their sign and return not-a-number from either side. Its products of
// large matrices fuse, and go by six rows at a time instead of by four: nothing in a step multiplies in this way.
#pragma once

#include <Eigen/Core>

#if defined(EIGEN_VECTORIZE_NEON)
namespace Eigen::internal {

// Registers for a size that is no multiple of four.
template <int Size>
struct find_best_packet_helper<Size, Packet4f, false> {
    using type = Packet4f;
};

// b < a ? b : a, as std::min and _mm_min_ps(b, a).
inline Packet4f first_least(Packet4f a, Packet4f b) { return vbslq_f32(vcltq_f32(b, a), b, a); }
inline Packet2d first_least(Packet2d a, Packet2d b) { return vbslq_f64(vcltq_f64(b, a), b, a); }
// b > a ? b : a
inline Packet4f first_largest(Packet4f a, Packet4f b) { return vbslq_f32(vcgtq_f32(b, a), b, a); }
inline Packet2d first_largest(Packet2d a, Packet2d b) { return vbslq_f64(vcgtq_f64(b, a), b, a); }

template <class Scalar>
struct FirstLeast : binary_op_base<Scalar, Scalar> {
    using result_type = Scalar;
    Scalar operator()(const Scalar& a, const Scalar& b) const { return b < a ? b : a; }
    template <class Packet>
    Packet packetOp(const Packet& a, const Packet& b) const {
        return first_least(a, b);
    }
    template <class Packet>
    Scalar predux(const Packet& a) const {
        return predux_min<PropagateFast>(a);  // number by number
    }
};
template <class Scalar>
struct FirstLargest : binary_op_base<Scalar, Scalar> {
    using result_type = Scalar;
    Scalar operator()(const Scalar& a, const Scalar& b) const { return b > a ? b : a; }
    template <class Packet>
    Packet packetOp(const Packet& a, const Packet& b) const {
        return first_largest(a, b);
    }
    template <class Packet>
    Scalar predux(const Packet& a) const {
        return predux_max<PropagateFast>(a);
    }
};
template <>
struct scalar_min_op<float, float, PropagateFast> : FirstLeast<float> {};
template <>
struct scalar_min_op<double, double, PropagateFast> : FirstLeast<double> {};
template <>
struct scalar_max_op<float, float, PropagateFast> : FirstLargest<float> {};
template <>
struct scalar_max_op<double, double, PropagateFast> : FirstLargest<double> {};

}  // namespace Eigen::internal
#endif
