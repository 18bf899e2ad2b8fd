#include "sim_controller/val3/language/unify_types.hpp"

#include "sim_controller/val3/language/scope.hpp"

namespace val3 {
namespace {

class TypesOfApplication {
 public:
  explicit TypesOfApplication(Application& application)
      : application_(application), first_(application.user_types.size()) {
    for (std::size_t i = 0; i < first_.size(); ++i) {
      first_[i] = i;
      for (std::size_t k = 0; k < i; ++k)
        if (first_[k] == k && type(k).name == type(i).name &&
            have_same_fields(application_, type(k), application_, type(i))) {
          first_[i] = k;
          break;
        }
    }
  }

  [[nodiscard]] bool has_copies() const {
    for (std::size_t i = 0; i < first_.size(); ++i)
      if (first_[i] != i) return true;
    return false;
  }

  void rewrite() {
    for (UserType& one : application_.user_types)
      for (Global& field : one.fields) rewrite(field);
    for (Global& global : application_.globals) rewrite(global);
    for (Program& program : application_.programs) {
      for (Declaration& local : program.locals) rewrite(local.type);
      for (Parameter& parameter : program.parameters) rewrite(parameter.type);
    }
  }

 private:
  [[nodiscard]] const UserType& type(std::size_t index) const { return application_.user_types[index]; }

  [[nodiscard]] bool is_listed(const Type& one) const {
    return one.user >= 0 && static_cast<std::size_t>(one.user) < first_.size();
  }

  void rewrite(Type& one) const {
    if (one.kind == Kind::kUser && is_listed(one))
      one.user = static_cast<int>(first_[static_cast<std::size_t>(one.user)]);
  }
  void rewrite(Global& global) const {
    rewrite(global.declared.type);
    rewrite(global.values);
  }
  void rewrite(std::vector<StoredValue>& values) const {
    for (StoredValue& value : values)
      for (StoredField& field : value.fields) {
        rewrite(field.declared.type);
        rewrite(field.values);
      }
  }

  Application& application_;
  std::vector<std::size_t> first_;  // the type of which each is a copy, or itself
};

}  // namespace

void unify_types(Application& application) {
  TypesOfApplication types(application);
  if (types.has_copies()) types.rewrite();
}

}  // namespace val3
