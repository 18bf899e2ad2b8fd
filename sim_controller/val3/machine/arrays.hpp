#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "sim_controller/val3/machine/run_error.hpp"
#include "sim_controller/val3/program/application.hpp"
#include "sim_controller/val3/program/values.hpp"

/// Variables: every one is an array of its type, a user's type a row of such arrays.
namespace val3 {

struct Screen {};  // a user page of s7: nothing of it is simulated

/// An array of one type, or a collection (elements by key). Its elements never change their type.
class ArrayBase {
 public:
  explicit ArrayBase(Type type) : type_(type) {}
  virtual ~ArrayBase() = default;
  ArrayBase(const ArrayBase&) = delete;
  ArrayBase& operator=(const ArrayBase&) = delete;

  [[nodiscard]] const Type& type() const { return type_; }
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Values in all of its elements: those of a user's type have those of their fields.
  [[nodiscard]] virtual std::size_t values() const = 0;
  /// Values of an element that is added.
  [[nodiscard]] virtual std::size_t values_of_new() const = 0;
  /// Of an element inside; it holds until the array is resized.
  [[nodiscard]] virtual void* address(std::size_t index) = 0;
  virtual void resize(std::size_t size) = 0;
  /// Element `index` becomes that of another array of this type.
  virtual void copy(std::size_t index, const ArrayBase& from, std::size_t from_index) = 0;
  /// Every element gets its default again.
  virtual void clear() = 0;
  virtual void clear(std::size_t index) = 0;
  /// All elements, sizes and keys become those of another array of this type.
  virtual void assign(const ArrayBase& from) = 0;
  [[nodiscard]] virtual std::shared_ptr<ArrayBase> clone() const = 0;

  bool is_global = false;                                // of an application or a library, by name
  std::vector<std::size_t> sizes{1};                     // one to three dimensions; of a collection none
  std::map<std::string, std::size_t, std::less<>> keys;  // of a collection

 private:
  Type type_;
};

/// An element of a user's type: its fields, each an array.
struct Record {
  Record() = default;
  Record(const Record& other) { *this = other; }
  Record(Record&&) = default;
  Record& operator=(const Record& other);  // of the same type
  Record& operator=(Record&&) = default;
  ~Record() = default;

  /// In all of its fields; one without elements counts for one, as it takes memory.
  [[nodiscard]] std::size_t values() const;

  std::vector<std::shared_ptr<ArrayBase>> fields;
};

/// The type of C++ that holds an element; void has none.
template <class T>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<T, double>) return Kind::kNum;
  if constexpr (std::is_same_v<T, bool>) return Kind::kBool;
  if constexpr (std::is_same_v<T, std::string>) return Kind::kString;
  if constexpr (std::is_same_v<T, Dio>) return Kind::kDio;
  if constexpr (std::is_same_v<T, Aio>) return Kind::kAio;
  if constexpr (std::is_same_v<T, Sio>) return Kind::kSio;
  if constexpr (std::is_same_v<T, Trsf>) return Kind::kTrsf;
  if constexpr (std::is_same_v<T, Frame>) return Kind::kFrame;
  if constexpr (std::is_same_v<T, Tool>) return Kind::kTool;
  if constexpr (std::is_same_v<T, Mdesc>) return Kind::kMdesc;
  if constexpr (std::is_same_v<T, Joint>) return Kind::kJoint;
  if constexpr (std::is_same_v<T, JointRs>) return Kind::kJointRs;
  if constexpr (std::is_same_v<T, Point>) return Kind::kPoint;
  if constexpr (std::is_same_v<T, Config>) return Kind::kConfig;
  if constexpr (std::is_same_v<T, Screen>) return Kind::kScreen;
  if constexpr (std::is_same_v<T, Blend>) return Kind::kBlend;
  if constexpr (std::is_same_v<T, Shoulder>) return Kind::kShoulder;
  if constexpr (std::is_same_v<T, Elbow>) return Kind::kElbow;
  if constexpr (std::is_same_v<T, Wrist>) return Kind::kWrist;
  if constexpr (std::is_same_v<T, Record>) return Kind::kUser;
  return Kind::kVoid;
}

/// Calls `work` with the C++ type of a kind: work.template operator()<T>(). Kinds without a machine type
/// (a SCARA's points) are refused before: std::logic_error.
template <class Work>
decltype(auto) with_type_of(Kind kind, Work&& work) {
  switch (kind) {
    case Kind::kNum:
      return work.template operator()<double>();
    case Kind::kBool:
      return work.template operator()<bool>();
    case Kind::kString:
      return work.template operator()<std::string>();
    case Kind::kDio:
      return work.template operator()<Dio>();
    case Kind::kAio:
      return work.template operator()<Aio>();
    case Kind::kSio:
      return work.template operator()<Sio>();
    case Kind::kTrsf:
      return work.template operator()<Trsf>();
    case Kind::kFrame:
      return work.template operator()<Frame>();
    case Kind::kTool:
      return work.template operator()<Tool>();
    case Kind::kMdesc:
      return work.template operator()<Mdesc>();
    case Kind::kJoint:
      return work.template operator()<Joint>();
    case Kind::kJointRs:
      return work.template operator()<JointRs>();
    case Kind::kPoint:
      return work.template operator()<Point>();
    case Kind::kConfig:
      return work.template operator()<Config>();
    case Kind::kScreen:
      return work.template operator()<Screen>();
    case Kind::kBlend:
      return work.template operator()<Blend>();
    case Kind::kShoulder:
      return work.template operator()<Shoulder>();
    case Kind::kElbow:
      return work.template operator()<Elbow>();
    case Kind::kWrist:
      return work.template operator()<Wrist>();
    case Kind::kUser:
      return work.template operator()<Record>();
    case Kind::kVoid:
    case Kind::kPointRs:
    case Kind::kConfigRs:
      break;
  }
  throw std::logic_error("a type that the machine does not have");
}
/// Whether the machine has values of this kind.
bool is_simulated(Kind kind);

template <class T>
class Array final : public ArrayBase {
 public:
  explicit Array(Type type, std::size_t size, const T& initial = T{}) : ArrayBase(type), initial_(initial) {
    sizes = {size};
    elements.assign(size, initial_);
  }

  [[nodiscard]] std::size_t size() const override { return elements.size(); }
  [[nodiscard]] std::size_t values() const override {
    if constexpr (std::is_same_v<T, Record>) {
      std::size_t all = 0;
      for (const Record& element : elements) all += element.values();
      return all;
    } else {
      return elements.size();
    }
  }
  [[nodiscard]] std::size_t values_of_new() const override {
    if constexpr (std::is_same_v<T, Record>) return initial_.values();
    return 1;
  }
  [[nodiscard]] void* address(std::size_t index) override { return &elements[index]; }
  void resize(std::size_t size) override { elements.resize(size, initial_); }
  void copy(std::size_t index, const ArrayBase& from, std::size_t from_index) override {
    elements[index] = static_cast<const Array&>(from).elements[from_index];
  }
  void clear() override { elements.assign(elements.size(), initial_); }
  void clear(std::size_t index) override { elements[index] = initial_; }
  void assign(const ArrayBase& from) override {
    elements = static_cast<const Array&>(from).elements;
    sizes = from.sizes;
    keys = from.keys;
  }
  [[nodiscard]] std::shared_ptr<ArrayBase> clone() const override {
    auto copied = std::make_shared<Array>(type(), 0, initial_);
    copied->assign(*this);
    return copied;
  }

  boost::container::small_vector<T, 1> elements;

 private:
  T initial_;
};

/// A place: an element of an array, or a field of it. Holds while the array lives; `keep` keeps one that is
/// part of a record.
struct Ref {
  ArrayBase* array = nullptr;
  std::size_t index = 0;      // of an array parameter: where its elements begin
  std::ptrdiff_t field = -1;  // of the element, in bytes; -1: the element itself
  std::shared_ptr<ArrayBase> keep;

  /// RunFailure 20 when the array has become shorter.
  template <class T>
  [[nodiscard]] T& at() const {
    if (field < 0) {
      auto& elements = static_cast<Array<T>*>(array)->elements;
      if (index >= elements.size()) throw RunFailure(kErrorIndex, "an index beyond the array");
      return elements[index];
    }
    if (index >= array->size()) throw RunFailure(kErrorIndex, "an index beyond the array");
    return *reinterpret_cast<T*>(static_cast<std::byte*>(array->address(index)) + field);  // NOLINT
  }
  /// Elements from here to the end.
  [[nodiscard]] std::size_t size() const {
    return field >= 0 ? 1 : array->size() - std::min(index, array->size());
  }
};

/// The index of an element by its indices: RunFailure 11 for what is no number, 20, 21.
std::size_t flat_index(const ArrayBase& array, std::size_t offset, const double* indices, std::size_t count);

}  // namespace val3
