// What the tests of continua loop over: shapes with patches of them, strains by another route, materials with their
// energies. The types of a shape and of a strain are found by their names: "STRAIN SHAPE".
#pragma once

#include <Eigen/Dense>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "constraints/element.h"
#include "constraints/material.h"
#include "constraints/random.h"
#include "constraints/shape_functions.h"
#include "instance.h"

namespace taut::test {

// ---------------------------------------------------------------- shapes

struct ShapePoint {
    std::vector<uint32_t> nodes;
    Matrix g;  // dim x nodes
    double weight;
};

struct Patch {
    std::vector<Vec3> rest;
    std::vector<ShapePoint> points;
    std::vector<uint32_t> inner;  // nodes with elements all round
    double content;               // area or volume
    Matrix axes;                  // 3 x dim, of the material in space
};

struct ShapeCase {
    const char* name;
    int dim;
    bool balanced;  // a constant stress has no force on inner nodes
    Patch (*patch)(uint64_t seed);
};
std::span<const ShapeCase> shape_cases();

// ---------------------------------------------------------------- strains

struct StrainCase {
    const char* name;
    Vector (*of)(const Matrix& f, double alpha);  // c, by Eigen's SVD
    bool unfolds;                                 // has a force out of F = 0
    bool mirrors;                                 // tells a mirrored solid from itself
};
std::span<const StrainCase> strain_cases();

// ---------------------------------------------------------------- materials

struct Constants {
    double young, poisson;
    double mu() const { return young / (2 * (1 + poisson)); }
    double lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
    double sheet_lambda() const { return young * poisson / (1 - poisson * poisson); }
};

struct MaterialCase {
    const char* name;
    const char* strain;
    int dim;
    bool (*make)(const Isotropic& of, double* compliance, double& alpha);
    double (*energy)(const Matrix& f, const Constants& of);  // a unit of volume [J/m^3], up to a constant
};
std::span<const MaterialCase> material_cases();

// ---------------------------------------------------------------- types

inline bool is_of_shape(const ElementType& type, const ShapeCase& shape) {
    return std::string_view(type.name).ends_with(std::string(" ") + shape.name);
}
inline bool is_of_strain(const ElementType& type, std::string_view strain) {
    return std::string_view(type.name).starts_with(std::string(strain) + " ");
}

// act(type, shape, strain) for all continua of the list; how many there were.
template <class Act>
int for_continua(Act act) {
    int count = 0;
    for (const ElementType* type : element_types())
        for (const ShapeCase& shape : shape_cases())
            for (const StrainCase& strain : strain_cases())
                if (is_of_shape(*type, shape) && is_of_strain(*type, strain.name)) ++count, act(*type, shape, strain);
    return count;
}

// act(type, shape, material), of those that fit.
template <class Act>
int for_materials(Act act) {
    int count = 0;
    for_continua([&](const ElementType& type, const ShapeCase& shape, const StrainCase& strain) {
        for (const MaterialCase& material : material_cases())
            if (std::string_view(material.strain) == strain.name && material.dim == shape.dim)
                ++count, act(type, shape, material);
    });
    return count;
}

// One element as a batch of one.
struct Single {
    explicit Single(const ElementType& t) : type(t), data(static_cast<size_t>(t.numbers)) {}
    // From the type's own sample.
    Single(const ElementType& t, uint64_t seed) : Single(t) {
        std::vector<double> room(data.size() + 1);
        type.row.sample(seed, room.data(), pose);
        std::copy_n(room.begin(), data.size(), data.begin());
    }
    int nodes() const { return type.row.nodes; }
    int dim() const { return type.numbers / nodes(); }
    int width() const { return 3 * nodes(); }
    Eigen::Map<Matrix> g() { return {data.data(), dim(), nodes()}; }
    double& alpha() { return data.back(); }
    Matrix positions() const {
        Matrix x(3, nodes());
        for (int n = 0; n < nodes(); ++n) x.col(n) = pose[n].x;
        return x;
    }
    void set_positions(const Matrix& x) {
        for (int n = 0; n < nodes(); ++n) pose[n].x = x.col(n);
    }
    Matrix f() { return positions() * g().transpose(); }
    // Moves the points to where F is wanted.
    void set_f(const Matrix& wanted) {
        const Matrix moment = g() * g().transpose();
        set_positions(positions() + (wanted - f()) * moment.inverse() * g());
    }
    ElementBatch view() const { return {1, order, nullptr, data.data(), pose}; }
    Vector error() const {
        Vector c(type.row.rows);
        type.evaluate(view(), c.data(), nullptr, 3);
        return c;
    }
    Matrix jacobian() const {
        Vector c(type.row.rows);
        std::vector<double> raw(static_cast<size_t>(type.row.rows * width()));
        type.evaluate(view(), c.data(), raw.data(), 3);
        Matrix j(type.row.rows, width());
        for (int n = 0; n < nodes(); ++n)
            j.middleCols(3 * n, 3) = Eigen::Map<RowMajor>(raw.data() + n * 3 * type.row.rows, type.row.rows, 3);
        return j;
    }
    Matrix stiffness(const Vector& lambda, Curvature part) const {
        RowMajor k(width(), width());
        type.stiffness(view(), lambda.data(), part, k.data());
        return k;
    }
    Matrix sum(const Vector& lambda, const Matrix& d) const {
        RowMajor k(width(), width()), material = d;
        const double softness = 1;
        positive_sum(type, view(), {material.data(), &softness}, lambda.data(), k.data());
        return k;
    }
    double energy(const Matrix& d) const {
        const RowMajor material = d;
        const double softness = 1;
        double out;
        element_energy(type, view(), {material.data(), &softness}, &out);
        return out;
    }
    // -dW/dx
    Vector force(const Matrix& d) const { return -jacobian().transpose() * (d * error()); }

    static constexpr uint32_t order[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const ElementType& type;
    std::vector<double> data;
    Pose pose[kMaxNodes];
};

// D of a material for an element, whose alpha it sets where it has one.
inline Matrix modulus_of(const MaterialCase& material, const Constants& constants, Single& element) {
    const int rows = element.type.row.rows;
    double compliance[36], alpha = 0;
    if (!material.make({constants.young, constants.poisson}, compliance, alpha)) return Matrix();
    if (alpha != 0) element.alpha() = alpha;
    return Eigen::Map<RowMajor>(compliance, rows, rows).inverse();
}

inline Mat3 random_rotation(uint64_t seed) { return Random(seed).rotation().toRotationMatrix(); }

}  // namespace taut::test
