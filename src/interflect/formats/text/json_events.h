#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace interflect::detail {

/// Handler of JSON events that accepts all valid JSON. Derived classes override the events they need.
template <class Json>
class JsonEvents : public nlohmann::json_sax<Json> {
    using Base = nlohmann::json_sax<Json>;

  public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(typename Base::number_integer_t) override { return true; }
    bool number_unsigned(typename Base::number_unsigned_t) override { return true; }
    bool number_float(typename Base::number_float_t, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(typename Base::binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(std::string&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }
};

}  // namespace interflect::detail
