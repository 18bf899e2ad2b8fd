#include "sim_controller/val3/program/application.hpp"

#include <algorithm>
#include <cctype>

namespace val3 {
namespace {

template <class Named, class Name>
int place_of(const std::vector<Named>& all, std::string_view name, Name name_of_one) {
  const auto found =
      std::ranges::find_if(all, [&](const Named& one) { return std::string_view(name_of_one(one)) == name; });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

}  // namespace

int Application::program_named(std::string_view wanted) const {
  return place_of(programs, wanted, [](const Program& one) -> const std::string& { return one.name; });
}

int Application::global_named(std::string_view wanted) const {
  return place_of(globals, wanted, [](const Global& one) -> const std::string& { return one.declared.name; });
}

int Application::library_named(std::string_view alias) const {
  return place_of(libraries, alias, [](const Library& one) -> const std::string& { return one.alias; });
}

bool Application::is_unread(std::string_view program) const {
  std::string lower(program);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::find(unread_programs, lower) != unread_programs.end();
}

int Application::user_type_named(std::string_view wanted) const {
  return place_of(user_types, wanted, [](const UserType& one) -> const std::string& { return one.name; });
}

std::string name_of(const Application& application, const Type& type) {
  const auto user = static_cast<std::size_t>(type.user);
  if (type.kind == Kind::kUser && type.user >= 0 && user < application.user_types.size())
    return application.user_types[user].name;
  return std::string(name_of(type.kind));
}

}  // namespace val3
