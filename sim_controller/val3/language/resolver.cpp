#include "sim_controller/val3/language/resolver.hpp"

#include <algorithm>
#include <deque>
#include <unordered_map>

#include "sim_controller/val3/language/line_resolver.hpp"
#include "sim_controller/val3/language/unify_types.hpp"

namespace val3 {
namespace {

/// All applications that one uses, each once.
void collect(Application& application, std::vector<Application*>& all) {
  if (std::find(all.begin(), all.end(), &application) != all.end()) return;
  all.push_back(&application);
  for (Library& library : application.libraries) {
    if (library.application) collect(*library.application, all);
    for (Loadable& loadable : library.loadable)
      if (loadable.application) collect(*loadable.application, all);
  }
}

void resolve_programs(Scope& scope, Application& application, Findings& findings) {
  for (Program& program : application.programs) {
    LineResolver lines(scope, program, findings);
    for (Line& line : program.lines) lines.resolve(program.lines, line);
  }
}

}  // namespace

void resolve(Application& application, Findings& findings) {
  std::vector<Application*> all;
  collect(application, all);
  for (Application* const one : all) unify_types(*one);
  std::deque<Scope> scopes;
  std::unordered_map<const Application*, const Scope*> scope_of;
  for (Application* const one : all) scope_of.emplace(one, &scopes.emplace_back(*one));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < all[i]->libraries.size(); ++k)
      if (const auto& library = all[i]->libraries[k].application)
        scopes[i].set_library_scope(k, scope_of.at(library.get()));
  // Libraries first: a type that is taken over from one is complete.
  for (std::size_t i = all.size(); i-- > 0;) resolve_programs(scopes[i], *all[i], findings);
}

}  // namespace val3
