// The typed half of options.h: each declaration becomes one OptionEntry.
#pragma once

#include <algorithm>

#include "base/check.h"
#include "base/number_text.h"
#include "base/options.h"

namespace trocar {

template <class T>
Options<T>& Options<T>::value(OptionEntry entry) {
  const T defaults{};
  add(std::move(entry), &defaults);
  return *this;
}

template <class T>
Options<T>& Options<T>::number(const std::string& key, double T::*member,
                               const Dimension& dimension, const Range& range,
                               const std::string& doc, Need need) {
  return value(
      {.key = key,
       .type_text = number_type_text(dimension),
       .range_text = range_text(range, dimension),
       .doc = doc,
       .need = need,
       .read = [=](const OptionNode& node,
                   void* object) { of(object).*member = read_number(node, dimension, range); },
       .value_text = [=](const void* object) { return number_text(of(object).*member); }});
}

template <class T>
Options<T>& Options<T>::integer(const std::string& key, int T::*member, const Range& range,
                                const std::string& doc, Need need) {
  return value(
      {.key = key,
       .type_text = "integer",
       .range_text = range_text(range, dim::none),
       .doc = doc,
       .need = need,
       .read = [=](const OptionNode& node,
                   void* object) { of(object).*member = read_integer(node, range); },
       .value_text = [=](const void* object) { return std::to_string(of(object).*member); }});
}

template <class T>
Options<T>& Options<T>::boolean(const std::string& key, bool T::*member, const std::string& doc) {
  return value({.key = key,
                .type_text = "boolean",
                .doc = doc,
                .read = [=](const OptionNode& node,
                            void* object) { of(object).*member = read_boolean(node); },
                .value_text = [=](const void* object) -> std::string {
                  return of(object).*member ? "true" : "false";
                }});
}

template <class T>
Options<T>& Options<T>::text(const std::string& key, std::string T::*member, const std::string& doc,
                             Need need) {
  return value(
      {.key = key,
       .type_text = "text",
       .doc = doc,
       .need = need,
       .read = [=](const OptionNode& node, void* object) { of(object).*member = read_text(node); },
       .value_text = [=](const void* object) { return quoted_text(of(object).*member); }});
}

template <class T>
Options<T>& Options<T>::vector(const std::string& key, Vec3 T::*member, const Dimension& dimension,
                               const Range& range, const std::string& doc, Need need) {
  return value({.key = key,
                .type_text = "3 x " + number_type_text(dimension),
                .range_text = range_text(range, dimension),
                .doc = doc,
                .need = need,
                .read =
                    [=](const OptionNode& node, void* object) {
                      const std::vector<double> values = read_numbers(node, dimension, 3, range);
                      of(object).*member = Vec3(values[0], values[1], values[2]);
                    },
                .value_text =
                    [=](const void* object) {
                      const Vec3& values = of(object).*member;
                      return numbers_text({values.data(), 3});
                    }});
}

template <class T>
template <std::size_t N>
Options<T>& Options<T>::integers(const std::string& key, std::array<int, N> T::*member,
                                 const Range& range, const std::string& doc) {
  return value(
      {.key = key,
       .type_text = std::to_string(N) + " x integer",
       .range_text = range_text(range, dim::none),
       .doc = doc,
       .read =
           [=](const OptionNode& node, void* object) {
             const std::vector<int> values = read_integers(node, N, range);
             std::copy(values.begin(), values.end(), (of(object).*member).begin());
           },
       .value_text = [=](const void* object) { return integers_text(of(object).*member); }});
}

template <class T>
template <class E>
Options<T>& Options<T>::choice(const std::string& key, E T::*member,
                               const std::vector<std::pair<std::string, E>>& choices,
                               const std::string& doc, Need need) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : choices) names.push_back(name);
  return value(
      {.key = key,
       .type_text = "one of " + choices_text(names),
       .doc = doc,
       .need = need,
       .read = [=](const OptionNode& node,
                   void* object) { of(object).*member = choices[read_choice(node, names)].second; },
       .value_text =
           [=](const void* object) {
             const auto found = std::find_if(choices.begin(), choices.end(), [&](const auto& one) {
               return one.second == of(object).*member;
             });
             CHECK(found != choices.end());  // each value of the struct has a name
             return quoted_text(found->first);
           }});
}

template <class T>
template <class U>
Options<T>& Options<T>::table(const std::string& key, U T::*member, const Options<U>& below,
                              Need need) {
  return value(
      {.key = key,
       .type_text = "table",
       .doc = below.doc(),
       .need = need,
       .is_table = true,
       .below = below.entries(),
       .make_below = [=](void* object,
                         std::size_t) { return std::vector<void*>{&(of(object).*member)}; },
       .objects_below =
           [=](const void* object) { return std::vector<const void*>{&(of(object).*member)}; }});
}

template <class T>
template <class U>
Options<T>& Options<T>::table(const std::string& key, std::optional<U> T::*member,
                              const Options<U>& below) {
  CHECK(!(T{}.*member).has_value());  // a file could not say that it is absent
  return value({.key = key,
                .type_text = "table, may be absent",
                .doc = below.doc(),
                .is_table = true,
                .below = below.entries(),
                .make_below =
                    [=](void* object, std::size_t) {
                      return std::vector<void*>{&(of(object).*member).emplace()};
                    },
                .objects_below =
                    [=](const void* object) {
                      const std::optional<U>& one = of(object).*member;
                      return one ? std::vector<const void*>{&*one} : std::vector<const void*>{};
                    }});
}

template <class T>
template <class U>
Options<T>& Options<T>::list(const std::string& key, std::vector<U> T::*member,
                             const Options<U>& below, const std::string& doc, Need need) {
  return value({.key = key,
                .type_text = "list of tables",
                .doc = doc,
                .need = need,
                .is_table = true,
                .is_list = true,
                .below = below.entries(),
                .make_below =
                    [=](void* object, std::size_t n) {
                      (of(object).*member).assign(n, U{});
                      std::vector<void*> objects;
                      for (U& one : of(object).*member) objects.push_back(&one);
                      return objects;
                    },
                .objects_below =
                    [=](const void* object) {
                      std::vector<const void*> objects;
                      for (const U& one : of(object).*member) objects.push_back(&one);
                      return objects;
                    }});
}

}  // namespace trocar
