#include "tests/bench/cluster/relay_messages.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "protocol/client/connection/connection.h"
#include "server/cli/common/command.h"
#include "tests/bench/cluster/relayed_service.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/support/pool_scene.h"

namespace vat::bench {
namespace {

using BenchClock = std::chrono::steady_clock;

struct MessagesOptions {
  std::vector<std::size_t> clients{10, 40, 160};
  double rate = 100;
  double seconds = 10;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/relay-messages";
};

constexpr const char* kHostThread = "vat-relay";
constexpr auto kPatience = std::chrono::seconds(30);
constexpr std::string_view kPoint =
    R"({"jsonrpc":"2.0","method":"presence.point","params":{"position":[0.1,0.2,0.3]}})";

/// A participant that points at a constant rate until the end.
class Pointer {
 public:
  explicit Pointer(std::uint16_t port) {
    const std::string url = "ws://127.0.0.1:" + std::to_string(port) + "/ws";
    connection_ = client::connect_websocket(client::read_websocket_url(url), {}, {},
                                            BenchClock::now() + kPatience)
                      .connection;
    if (connection_ == nullptr) throw std::runtime_error("a relay refuses a client");
    connection_->send_text(
        R"({"jsonrpc":"2.0","id":1,"method":"session.join","params":{"session":"s1"}})");
    wait_for(R"("id":1)");
  }

  /// Sends messages. Returns their number.
  std::size_t point(double rate, const std::atomic<bool>& ends) {
    const std::chrono::duration<double> interval(1 / rate);
    const auto begin = BenchClock::now();
    std::size_t sent = 0;
    while (!ends) {
      connection_->send_text(std::string(kPoint));
      ++sent;
      const auto next = begin + std::chrono::duration_cast<BenchClock::duration>(
                                    static_cast<double>(sent) * interval);
      while (connection_->next(next)) {  // the events of other participants
      }
    }
    return sent;
  }
  /// Waits until the owner has taken all messages.
  void finish() {
    connection_->send_text(R"({"jsonrpc":"2.0","id":2,"method":"session.stats"})");
    wait_for(R"("id":2)");
  }

 private:
  void wait_for(std::string_view part) {
    for (;;) {
      const auto message = connection_->next(BenchClock::now() + kPatience);
      if (!message || message->kind == client::Message::Kind::closed) {
        throw std::runtime_error("a client receives no reply");
      }
      if (message->bytes.find(part) == std::string::npos) continue;
      if (message->bytes.find(R"("error")") == std::string::npos) return;
      throw std::runtime_error(message->bytes);
    }
  }
  std::unique_ptr<client::Connection> connection_;
};

struct MessagesRow {
  std::size_t clients = 0;
  double messages = 0;            ///< per second
  double host = 0;                ///< processor time of the thread that reads the messages [cores]
  std::array<double, 3> cores{};  ///< owner, relays, NATS
};

MessagesRow measure_messages(const MessagesOptions& options, const std::filesystem::path& folder,
                             const std::string& scene, std::size_t clients) {
  std::filesystem::remove_all(folder);
  const RelayedService service(options.program, folder, scene, clients);
  std::vector<std::unique_ptr<Pointer>> pointers;
  for (std::size_t i = 0; i < clients; ++i) {
    pointers.push_back(std::make_unique<Pointer>(service.relay_port(i % RelayedService::kRelays)));
  }
  std::atomic<bool> ends = false;
  std::atomic<std::size_t> sent = 0;
  const auto begin = BenchClock::now();
  const auto before = service.processor_seconds();
  const double host_before = service.owner().seconds_of_thread(kHostThread);
  std::vector<std::thread> threads;
  for (const auto& pointer : pointers) {
    threads.emplace_back(
        [&, client = pointer.get()] { sent += client->point(options.rate, ends); });
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  ends = true;
  for (std::thread& thread : threads) thread.join();
  for (const auto& pointer : pointers) pointer->finish();
  const double time = std::chrono::duration<double>(BenchClock::now() - begin).count();
  const auto after = service.processor_seconds();
  MessagesRow row{clients,
                  static_cast<double>(sent) / time,
                  (service.owner().seconds_of_thread(kHostThread) - host_before) / time,
                  {}};
  for (std::size_t part = 0; part < row.cores.size(); ++part) {
    row.cores[part] = (after[part] - before[part]) / time;
  }
  return row;
}

Table to_messages_table(const std::vector<MessagesRow>& rows) {
  const Machine machine = this_machine();
  Table table{{"clients", "messages per second", "reading thread [us per message]",
               "reading thread [cores]", "owner [cores]", "relays [cores]", "NATS [cores]",
               "commit", "cpu", "cores of the machine"},
              {}};
  for (const MessagesRow& row : rows) {
    table.rows.push_back({std::uint64_t{row.clients}, row.messages, 1e6 * row.host / row.messages,
                          row.host, row.cores[0], row.cores[1], row.cores[2], machine.commit,
                          machine.cpu, std::uint64_t{machine.cores}});
  }
  return table;
}

int run_messages(const MessagesOptions& options) {
  const std::filesystem::path folder = std::filesystem::absolute(options.output);
  std::filesystem::create_directories(folder);
  const std::string scene = folder / "scene.json";
  if (const Status written = write_text(scene, test::kPoolScene); !written) {
    return fail(scene, written.errors());
  }
  const auto rows =
      measure_each<MessagesRow>("relay-messages", options.clients, [&](std::size_t clients) {
        return measure_messages(options, folder / "data", scene, clients);
      });
  if (!rows) return kExitFailed;
  const Table table = to_messages_table(*rows);
  std::cout << '\n' << to_markdown(table);
  const Status written =
      write_table(table, options.output, "relay_messages", "# Messages of clients at two relays");
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_relay_messages_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "relay-messages", "Messages of clients at two relays to the owner of their session");
  const auto options = std::make_shared<MessagesOptions>();
  command->add_option("--clients", options->clients, "Numbers of clients, at both relays together")
      ->check(CLI::Range(2, 1000))
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--rate", options->rate, "Messages per second of each client")
      ->check(CLI::Range(1, 250))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Measured time [s]")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the nodes' data")
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 the servers or the clients failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_messages(*options); });
}

}  // namespace vat::bench
