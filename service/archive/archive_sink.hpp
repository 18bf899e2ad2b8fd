#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "service/plant/sink.hpp"

namespace cell {

inline constexpr std::chrono::minutes kClocksApartMax{5};
inline constexpr std::chrono::seconds kArchivePatience{30};

/// A sink that keeps the facts of a cell in a PostgreSQL, with the touches, the result, the arm and the plan
/// of each run that ended: one transaction a few facts, and what is there already stays. `store` is the
/// cell's database, of which it reads those over a connection of its own. Connects; SinkTrouble where that
/// fails, and for an archive that is not prepared, or by another version. A statement that is not answered
/// within `patience` is SinkTrouble, too, as is one that is under way when `ending` is asked for. Where the
/// archive's clock and `clock`, that of the facts, are more than kClocksApartMax apart, its remark() says so;
/// without, it is not compared.
std::unique_ptr<Sink> connect_archive(
    const std::string& url, const std::string& cell, const std::filesystem::path& store,
    const std::stop_token& ending = {}, std::chrono::milliseconds patience = kArchivePatience,
    const std::function<std::chrono::system_clock::time_point()>& clock = {});

}  // namespace cell
