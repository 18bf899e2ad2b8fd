#include "sim_controller/val3/machine/assignments.hpp"

#include <algorithm>
#include <span>

#include "sim_controller/val3/machine/channels.hpp"
#include "sim_controller/val3/machine/signals.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// Writes one value to variables of its own type.
template <class T>
class SetOperation final : public Operation {
 public:
  SetOperation(std::vector<PlaceNodePtr<T>> places, NodePtr<T> value)
      : places_(std::move(places)), value_(std::move(value)) {}
  Flow run(Context& context) const override {
    const T value = value_->get(context);
    if constexpr (std::is_same_v<T, Record>) context.tasks.charge((places_.size() + 1) * value.values());
    for (auto place = places_.rbegin(); place != places_.rend(); ++place) (*place)->at(context) = value;
    return Flow::kGo;
  }

 private:
  std::vector<PlaceNodePtr<T>> places_;
  NodePtr<T> value_;
};

/// A place of an assignment, whatever takes the value in it.
template <class T>
class Target {
 public:
  Target() = default;
  virtual ~Target() = default;
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  /// Wait where the place cannot take a value yet.
  virtual void demand_ready(Context&) const {}
  virtual void write(Context& context, const T& value) const = 0;
};
template <class T>
using TargetPtr = std::unique_ptr<const Target<T>>;

template <class T>
class VariableTarget final : public Target<T> {
 public:
  explicit VariableTarget(PlaceNodePtr<T> place) : place_(std::move(place)) {}
  void write(Context& context, const T& value) const override { place_->at(context) = value; }

 private:
  PlaceNodePtr<T> place_;
};

class DigitalTarget final : public Target<bool> {
 public:
  explicit DigitalTarget(NodePtr<Dio> signal) : signal_(std::move(signal)) {}
  void write(Context& context, const bool& on) const override {
    write_signal(context, signal_->get(context), on);
  }

 private:
  NodePtr<Dio> signal_;
};

class AnalogueTarget final : public Target<double> {
 public:
  explicit AnalogueTarget(NodePtr<Aio> signal) : signal_(std::move(signal)) {}
  void write(Context& context, const double& value) const override {
    write_analogue(context, signal_->get(context), value);
  }

 private:
  NodePtr<Aio> signal_;
};

template <class T>
class ChannelTarget final : public Target<T> {
 public:
  explicit ChannelTarget(NodePtr<Sio> channel) : channel_(std::move(channel)) {}
  void demand_ready(Context& context) const override { demand_writable(context, channel_->get(context)); }
  void write(Context& context, const T& value) const override {
    if constexpr (std::is_same_v<T, double>)
      write_byte(context, channel_->get(context), value);
    else
      write_text(context, channel_->get(context), value);
  }

 private:
  NodePtr<Sio> channel_;
};

/// Writes one value to places of several types. A line that waits is carried out again as a whole, so that
/// nothing is read or written before every place can take the value.
template <class T>
class WriteOperation final : public Operation {
 public:
  WriteOperation(std::vector<TargetPtr<T>> targets, NodePtr<T> value)
      : targets_(std::move(targets)), value_(std::move(value)) {}
  Flow run(Context& context) const override {
    for (const auto& target : targets_) target->demand_ready(context);
    const T value = value_->get(context);
    for (auto target = targets_.rbegin(); target != targets_.rend(); ++target)
      (*target)->write(context, value);
    return Flow::kGo;
  }

 private:
  std::vector<TargetPtr<T>> targets_;
  NodePtr<T> value_;
};

bool is_link(Kind kind) { return kind == Kind::kDio || kind == Kind::kAio || kind == Kind::kSio; }

class AssignmentCompiler {
 public:
  AssignmentCompiler(Compiler& compiler, const Line& line)
      : compiler_(compiler),
        value_(line.expressions.back()),
        places_(line.expressions.data(), line.expressions.size() - 1) {}

  OperationPtr operation() {
    for (const Expression& place : places_)
      if (!is_simulated(place.type.kind))
        compiler_.refuse_type(place, "a variable of this type is not simulated");
    if (std::ranges::any_of(places_, [](const Expression& place) { return is_link(place.type.kind); }))
      return writing();
    const Type& type = places_[0].type;
    for (const Expression& place : places_)
      if (place.type != type) refuse_mixture(place);
    return with_type_of(type.kind, [&]<class T>() -> OperationPtr {
      std::vector<PlaceNodePtr<T>> variables;
      for (const Expression& place : places_) variables.push_back(compiler_.place<T>(place));
      return std::make_unique<const SetOperation<T>>(std::move(variables), compiler_.value<T>(value_));
    });
  }

 private:
  OperationPtr writing() {
    switch (kind_of_value()) {
      case Kind::kBool:
        return written<bool>();
      case Kind::kString:
        return written<std::string>();
      default:
        return written<double>();
    }
  }

  /// What the places take. Channels take numbers and strings: there another place decides, else the value.
  [[nodiscard]] Kind kind_of_value() const {
    for (const Expression& place : places_) {
      if (place.type.kind == Kind::kDio) return Kind::kBool;
      if (place.type.kind == Kind::kAio) return Kind::kNum;
      if (!is_link(place.type.kind)) return place.type.kind;
    }
    return value_.type.kind == Kind::kString ? Kind::kString : Kind::kNum;
  }

  template <class T>
  OperationPtr written() {
    std::vector<TargetPtr<T>> targets;
    for (const Expression& place : places_) targets.push_back(target<T>(place));
    return std::make_unique<const WriteOperation<T>>(std::move(targets), compiler_.value<T>(value_));
  }

  template <class T>
  TargetPtr<T> target(const Expression& place) {
    const Kind kind = place.type.kind;
    if (kind == kind_of<T>()) return std::make_unique<const VariableTarget<T>>(compiler_.place<T>(place));
    if constexpr (std::is_same_v<T, bool>) {
      if (kind == Kind::kDio) return std::make_unique<const DigitalTarget>(compiler_.value<Dio>(place));
    }
    if constexpr (std::is_same_v<T, double>) {
      if (kind == Kind::kAio) return std::make_unique<const AnalogueTarget>(compiler_.value<Aio>(place));
    }
    if constexpr (!std::is_same_v<T, bool>) {
      if (kind == Kind::kSio) return std::make_unique<const ChannelTarget<T>>(compiler_.value<Sio>(place));
    }
    refuse_mixture(place);
  }

  [[noreturn]] void refuse_mixture(const Expression& place) const {
    compiler_.refuse(place,
                     "an assignment to places that do not take one and the same value is not simulated");
  }

  Compiler& compiler_;
  const Expression& value_;
  std::span<const Expression> places_;
};

}  // namespace

OperationPtr assignment_operation(Compiler& compiler, const Line& line) {
  return AssignmentCompiler(compiler, line).operation();
}

}  // namespace val3
