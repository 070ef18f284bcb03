/// Colours and vectors as tuples of three numbers; a number for a grey colour.
#pragma once

#include <ImathColor.h>
#include <ImathVec.h>
#include <pybind11/pybind11.h>

#include <type_traits>

namespace pybind11::detail {

template <class Vector, class Number>
struct three_numbers {
    PYBIND11_TYPE_CASTER(Vector, const_name("tuple[float, float, float]"));

    bool load(handle source, bool) {
        constexpr bool is_colour = std::is_base_of_v<Imath::Color3<Number>, Vector>;
        if (PyFloat_Check(source.ptr()) || PyLong_Check(source.ptr()) || PyNumber_Check(source.ptr())) {
            if (PySequence_Check(source.ptr()) == 0 || PySequence_Size(source.ptr()) < 0) {
                PyErr_Clear();
                const double grey = PyFloat_AsDouble(source.ptr());
                if (PyErr_Occurred()) return PyErr_Clear(), false;
                value = Vector(static_cast<Number>(grey));
                return is_colour;
            }
        }
        if (PySequence_Check(source.ptr()) == 0 || isinstance<str>(source) || PySequence_Size(source.ptr()) != 3)
            return PyErr_Clear(), false;
        for (int i = 0; i < 3; ++i) {
            const auto item = reinterpret_steal<object>(PySequence_GetItem(source.ptr(), i));
            const double number = item ? PyFloat_AsDouble(item.ptr()) : 0;
            if (PyErr_Occurred()) return PyErr_Clear(), false;
            value[i] = static_cast<Number>(number);
        }
        return true;
    }

    static handle cast(const Vector& v, return_value_policy, handle) { return make_tuple(v[0], v[1], v[2]).release(); }
};

template <>
struct type_caster<Imath::V3f> : three_numbers<Imath::V3f, float> {};
template <>
struct type_caster<Imath::V3d> : three_numbers<Imath::V3d, double> {};
template <>
struct type_caster<Imath::Color3f> : three_numbers<Imath::Color3f, float> {};
template <>
struct type_caster<Imath::Color3<double>> : three_numbers<Imath::Color3<double>, double> {};

}  // namespace pybind11::detail
