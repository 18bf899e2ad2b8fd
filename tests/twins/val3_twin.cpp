#include <filesystem>
#include <stdexcept>
#include <utility>

#include "cs8_protocol/codec.hpp"
#include "sim_controller/frame_stream.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "sim_controller/val3_controller.hpp"
#include "tests/twins/twin.hpp"

namespace twins {
namespace {

/// The application as it goes onto a controller; read once.
const val3::Application& application() {
  static const val3::Application loaded = [] {
    val3::ReadApplication read =
        val3::read_application(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "cs8_protocol/val3/touchcal");
    val3::resolve(read.application, read.findings);
    for (const val3::Finding& found : read.findings) {
      if (found.severity == val3::Severity::kError) throw std::logic_error(found.at.file + ": " + found.what);
    }
    return std::move(read.application);
  }();
  return loaded;
}

/// The VAL3 application in the simulated cell, its socket's bytes cut into messages.
class Val3Twin final : public Twin {
 public:
  explicit Val3Twin(const Scenario& scenario)
      : controller_(plant(), application(),
                    {.seed = scenario.seed,
                     .duties = {.powers_up = false},
                     .faults = scenario.faults,
                     .system = {.clock_s = kStartSeconds}},
                    findings_) {
    if (!findings_.empty()) throw std::logic_error(findings_.front().what);
  }

  void tick() override {
    controller_.tick();
    if (sim::Val3Channel* channel = controller_.host_channel()) {
      for (const sim::FrameStream::Piece& piece : stream_.feed(channel->take())) {
        if (!piece.message) throw std::logic_error("the application sent bytes that are no frame");
        controller_.note_sent(*piece.message);
        if (is_connected_) sent_.push_back(*piece.message);
      }
      if (channel->peer() == sim::Val3Channel::Peer::kNone) is_connected_ = false;
    }
  }
  bool connect() override {
    sim::Val3Channel* channel = controller_.host_channel();
    if (channel == nullptr || !channel->accept()) return false;
    stream_.reset();
    is_connected_ = true;
    return true;
  }
  void disconnect() override {
    if (!std::exchange(is_connected_, false)) return;
    controller_.host_channel()->leave();
    sent_.clear();
  }
  bool is_connected() override { return is_connected_; }
  void give(const cs8::Message& message) override {
    controller_.note_received(message);
    controller_.host_channel()->give(cs8::encode(message));
  }
  std::vector<cs8::Message> take() override { return std::exchange(sent_, {}); }

  [[nodiscard]] double clock_s() const override { return controller_.clock_s() - kStartSeconds; }
  sim::Cabinet& cabinet() override { return controller_.cabinet(); }
  sim::Operator& person() override { return controller_.person(); }
  sim::FaultPlan& plan() override { return controller_.plan(); }

 private:
  val3::Findings findings_;
  sim::Val3Controller controller_;
  sim::FrameStream stream_;
  std::vector<cs8::Message> sent_;
  bool is_connected_ = false;
};

}  // namespace

std::unique_ptr<Twin> make_val3_twin(const Scenario& scenario) {
  return std::make_unique<Val3Twin>(scenario);
}

}  // namespace twins
