#pragma once

#include <cstddef>

#include "sim_controller/val3/program/application.hpp"

/// Run memory: what a task's calls take of its stackSize (manual 6, page 18: the call stack, with parameters
/// and locals). No manual says how many bytes that is, so it is estimated, and low on purpose: a program that
/// runs on a controller must run here.
///
/// A call takes kCallBytes and, for each parameter by reference, kReferenceBytes; for each other parameter
/// and each local kVariableBytes and its elements: a num 8, a bool 1, a string 16 (its text is not counted),
/// a dio, aio or sio 8, a joint 8 an axis, a trsf 48, a structure the sum of its fields and 8 for its father.
namespace val3 {

inline constexpr std::size_t kCallBytes = 32;
inline constexpr std::size_t kReferenceBytes = 8;
inline constexpr std::size_t kVariableBytes = 16;
/// What a task takes beside its calls: of the memory of all tasks together, not of its stackSize.
inline constexpr std::size_t kTaskBytes = 1024;

/// What SRS gives a new project, and what a stackSize of 0 is taken for.
inline constexpr std::size_t kUsualStackBytes = 5000;

/// Estimated bytes of one call of `program`, which is of `application`.
std::size_t bytes_of_call(const Application& application, const Program& program);

/// Run memory that each task of the application has.
std::size_t run_memory_of(const Application& application);

}  // namespace val3
