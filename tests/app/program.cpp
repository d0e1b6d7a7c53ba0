#include "tests/app/program.h"

#include <csignal>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

// Ends a run that hangs: far beyond what any takes here under a sanitizer on a busy machine.
constexpr auto kTooLong = std::chrono::seconds(120);
constexpr auto kPoll = std::chrono::milliseconds(2);

}  // namespace

Program::~Program() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

std::string Program::read(const std::string& name) const { return readFile(path(name)).value(); }

void Program::start(const std::vector<std::string>& words) {
  std::vector<std::string> all = {LIGHTVANE_PROGRAM};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string out = captured_ / "out";
  const std::string err = captured_ / "err";
  const int outFile = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const int errFile = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  process_ = fork();
  if (process_ == 0) {
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    dup2(outFile, STDOUT_FILENO);
    dup2(errFile, STDERR_FILENO);
    // No window may open on the desktop of whoever runs the tests.
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    if (chdir(folder().c_str()) == 0) execv(LIGHTVANE_PROGRAM, pointers.data());
    _exit(127);
  }
  close(outFile);
  close(errFile);
}

bool Program::waitForError(const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kTooLong;
  while (std::chrono::steady_clock::now() < end) {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (readFile(captured_ / "err").value().find(text) != std::string::npos) return true;
    if (info.si_pid == process_) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return false;
}

void Program::signal(int number) const { kill(process_, number); }

Outcome Program::finish() {
  Outcome outcome;
  int status = 0;
  const auto end = std::chrono::steady_clock::now() + kTooLong;
  while (waitpid(process_, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) kill(process_, SIGKILL);
    std::this_thread::sleep_for(kPoll);
  }
  process_ = -1;
  outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = readFile(captured_ / "out").value();
  outcome.err = readFile(captured_ / "err").value();
  return outcome;
}

Outcome Program::run(const std::vector<std::string>& words) {
  start(words);
  return finish();
}

std::string shippedScene(const std::string& name) {
  return std::string(LIGHTVANE_SOURCE_DIR) + "/assets/scenes/" + name + ".toml";
}

}  // namespace lightvane
