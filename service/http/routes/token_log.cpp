#include "service/http/routes/internal/token_log.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string_view>

#include "service/base/state_directory.hpp"

namespace cell {
namespace {

void tell_change(std::string_view file, const std::string& before, const std::string& now) {
  if (now == before) return;
  if (!before.empty()) spdlog::info("the token that {} held does not count any more", file);
  if (!now.empty()) spdlog::info("another token in {} counts now", file);
}

}  // namespace

void TokenTroubles::tell(const CurrentTokens& now) {
  const auto is_new = [this](const std::string& line) {
    return std::ranges::find(told_, line) == told_.end();
  };
  for (const std::string& trouble : now.troubles)
    if (is_new(trouble)) spdlog::error("{}; what it is of does not count until then", trouble);
  for (const std::string& trouble : now.kept)
    if (is_new(trouble)) spdlog::warn("{}; what was read before counts until then", trouble);
  told_ = now.troubles;
  told_.insert(told_.end(), now.kept.begin(), now.kept.end());
}

void tell_changes(const Tokens& before, const Tokens& now) {
  tell_change(kOperateTokenFile, before.operate, now.operate);
  tell_change(kViewTokenFile, before.view, now.view);
  for (const NamedToken& token : before.operators)
    if (std::ranges::find(now.operators, token) == now.operators.end())
      spdlog::info("the operate token of {} does not count any more", token.name);
  for (const NamedToken& token : now.operators)
    if (std::ranges::find(before.operators, token) == before.operators.end())
      spdlog::info("an operate token of {} counts now", token.name);
}

}  // namespace cell
