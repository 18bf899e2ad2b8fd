#include "sim_controller/val3/files/declaration_checks.hpp"

#include <map>
#include <unordered_map>

#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/stored_attributes.hpp"

namespace val3 {
namespace {

class FatherCheck {
 public:
  FatherCheck(const Application& application, Findings& findings)
      : application_(application), findings_(findings) {}

  void run() {
    for (const Global& global : application_.globals)
      for (const StoredValue& value : global.values) check(global.declared, value);
    find_circles();
  }

 private:
  void tell(std::string_view rule, const Declaration& declared, int line, std::string what,
            std::string remedy) {
    FileFindings(declared.file, findings_).error(rule, line, std::move(what), std::move(remedy));
  }

  void check(const Declaration& declared, const StoredValue& value) {
    for (const StoredField& field : value.fields)
      for (const StoredValue& inner : field.values) check(field.declared, inner);
    const auto attribute = value.attributes.find("fatherId");
    if (attribute == value.attributes.end()) return;
    const auto father = father_in(attribute->second);
    if (!father) return;  // told when it was read
    const Kind wanted = declared.type.kind == Kind::kTool ? Kind::kTool : Kind::kFrame;
    if (father->alias.empty() && father->name == (wanted == Kind::kTool ? "flange" : "world")) return;
    const Application* const owner = owner_of(*father, declared, value);
    if (owner != nullptr) check_in(*owner, *father, wanted, declared, value);
  }

  /// The application that has the father; null when it cannot be told, or is found.
  const Application* owner_of(const StoredFather& father, const Declaration& declared,
                              const StoredValue& value) {
    if (father.alias.empty()) return &application_;
    const int library = application_.library_named(father.alias);
    if (library >= 0) return application_.libraries[static_cast<std::size_t>(library)].application.get();
    tell(file_rules::kMissingFather, declared, value.line,
         declared.name + " is given in a frame of " + shown_word(father.alias) + ", which is no library", "");
    return nullptr;
  }

  void check_in(const Application& owner, const StoredFather& father, Kind wanted,
                const Declaration& declared, const StoredValue& value) {
    const auto place = places_in(owner).find(father.name);
    if (place == places_in(owner).end())
      return tell(file_rules::kMissingFather, declared, value.line,
                  declared.name + " is given in " + shown_word(father.name) + ", which is not there",
                  "add it, or choose another");
    const Declaration& found = owner.globals[place->second].declared;
    if (found.type.kind != wanted)
      return tell(
          file_rules::kMissingFather, declared, value.line,
          declared.name + " is given in " + father.name + ", which is a " + name_of(owner, found.type),
          "choose a " + std::string(name_of(wanted)));
    if (found.sizes.size() == 1 && father.index >= found.sizes[0])
      tell(file_rules::kMissingFather, declared, value.line,
           declared.name + " is given in " + father.name + '[' + std::to_string(father.index) + "], of " +
               std::to_string(found.sizes[0]) + " elements",
           "choose one that is there");
  }

  /// The places of the globals, by name: a file may hold a hundred thousand of them.
  const std::unordered_map<std::string_view, std::size_t>& places_in(const Application& owner) {
    const auto [places, is_new] = places_.try_emplace(&owner);
    if (is_new)
      for (std::size_t i = 0; i < owner.globals.size(); ++i)
        places->second.try_emplace(owner.globals[i].declared.name, i);
    return places->second;
  }

  static bool can_be_father(Kind kind) { return kind == Kind::kFrame || kind == Kind::kTool; }

  /// Numbers the values of frames and tools, and says which is given in which.
  void find_circles() {
    struct Given {
      const Global* global;
      const StoredValue* value;
      std::size_t father;  // kNone at the end of a chain
    };
    std::vector<Given> all;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> by_place;  // of the global, of the element
    for (std::size_t i = 0; i < application_.globals.size(); ++i) {
      const Global& global = application_.globals[i];
      if (!can_be_father(global.declared.type.kind)) continue;
      for (const StoredValue& value : global.values) {
        if (value.index.size() != 1) continue;
        by_place.emplace(std::pair{i, value.index[0]}, all.size());
        all.push_back({&global, &value, kNone});
      }
    }
    for (Given& one : all) {
      const auto attribute = one.value->attributes.find("fatherId");
      const auto father =
          attribute == one.value->attributes.end() ? std::nullopt : father_in(attribute->second);
      if (!father || !father->alias.empty()) continue;
      const auto global = places_in(application_).find(father->name);
      if (global == places_in(application_).end()) continue;
      const auto place = by_place.find({global->second, father->index});
      if (place != by_place.end()) one.father = place->second;
    }
    std::vector<std::size_t> walk_of(all.size(), kNone);  // the walk that came by first
    for (std::size_t walk = 0; walk < all.size(); ++walk) {
      std::size_t at = walk;
      while (at != kNone && walk_of[at] == kNone) {
        walk_of[at] = walk;
        at = all[at].father;
      }
      if (at != kNone && walk_of[at] == walk)
        tell(file_rules::kCircularFather, all[at].global->declared, all[at].value->line,
             all[at].global->declared.name + " is given in itself, by way of its father",
             "choose another father");
    }
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::map<const Application*, std::unordered_map<std::string_view, std::size_t>> places_;
  const Application& application_;
  Findings& findings_;
};

}  // namespace

void check_fathers(const Application& application, Findings& findings) {
  FatherCheck(application, findings).run();
}

void check_start_and_stop(const Application& application, Findings& findings) {
  const int start = application.program_named("start");
  const int stop = application.program_named("stop");
  const bool start_is_unread = start < 0 && application.is_unread("start");
  const bool stop_is_unread = stop < 0 && application.is_unread("stop");
  FileFindings project(application.project, findings);
  if (start < 0 && stop < 0 && !start_is_unread && !stop_is_unread)
    return project.warning(file_rules::kNoStart, 0,
                           "there is neither start() nor stop(): a library or a type, no application",
                           "write both to run it by itself");
  if (start < 0 && !start_is_unread)
    project.error(file_rules::kNoStart, 0, "there is no program start()",
                  "write it: the application begins with it");
  if (stop < 0 && !stop_is_unread)
    project.error(file_rules::kNoStop, 0, "there is no program stop()",
                  "write it: the application ends with it");
  for (const int index : {start, stop}) {
    if (index < 0) continue;
    const Program& program = application.programs[static_cast<std::size_t>(index)];
    if (program.parameters.empty()) continue;
    FileFindings(program.file, findings)
        .error(file_rules::kStartParameters, program.parameters[0].line, program.name + "() has parameters",
               "remove them: nobody passes any");
  }
}

}  // namespace val3
