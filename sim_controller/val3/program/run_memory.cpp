#include "sim_controller/val3/program/run_memory.hpp"

namespace val3 {
namespace {

constexpr std::size_t kNumberBytes = 8;
constexpr std::size_t kWordBytes = 1;  // a bool, a blend, a part of a configuration
constexpr std::size_t kTextBytes = 16;
constexpr std::size_t kLinkBytes = 8;
constexpr std::size_t kFatherBytes = 8;
/// Types in types deeper than this are not counted: the reader refuses them.
constexpr int kTypesCountedDeepMax = 16;

std::size_t bytes_of_element(const Application& application, const Type& type, int deep);

std::size_t bytes_of_variable(const Application& application, const Declaration& declared, int deep) {
  return kVariableBytes + declared.count() * bytes_of_element(application, declared.type, deep);
}

std::size_t bytes_of_fields(const Application& application, const Type& type, int deep) {
  std::size_t bytes = 0;
  for (const Field& field : fields_of(type.kind))
    bytes += bytes_of_element(application, {field.kind, -1}, deep);
  return bytes;
}

std::size_t bytes_of_element(const Application& application, const Type& type, int deep) {
  switch (type.kind) {
    case Kind::kNum:
      return kNumberBytes;
    case Kind::kString:
    case Kind::kScreen:
      return kTextBytes;
    case Kind::kDio:
    case Kind::kAio:
    case Kind::kSio:
      return kLinkBytes;
    case Kind::kPoint:
    case Kind::kPointRs:
    case Kind::kFrame:
    case Kind::kTool:
      return kFatherBytes + bytes_of_fields(application, type, deep);
    case Kind::kUser: {
      const auto index = static_cast<std::size_t>(type.user);
      if (index >= application.user_types.size() || deep >= kTypesCountedDeepMax) return 0;
      std::size_t bytes = 0;
      for (const Global& field : application.user_types[index].fields)
        bytes += bytes_of_variable(application, field.declared, deep + 1);
      return bytes;
    }
    default:
      return fields_of(type.kind).empty() ? kWordBytes : bytes_of_fields(application, type, deep);
  }
}

}  // namespace

std::size_t bytes_of_call(const Application& application, const Program& program) {
  std::size_t bytes = kCallBytes;
  for (const Parameter& parameter : program.parameters)
    bytes += parameter.by_reference ? kReferenceBytes
                                    : kVariableBytes + bytes_of_element(application, parameter.type, 0);
  for (const Declaration& local : program.locals) bytes += bytes_of_variable(application, local, 0);
  return bytes;
}

std::size_t run_memory_of(const Application& application) {
  return application.stack_bytes == 0 ? kUsualStackBytes : application.stack_bytes;
}

}  // namespace val3
