#include "tests/support/child_process.h"

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lightvane {
namespace {

constexpr auto kChildPoll = std::chrono::milliseconds(2);

int openForWriting(const std::filesystem::path& path) {
  return open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
}

}  // namespace

ChildProcess::ChildProcess(const Start& start) {
  std::vector<std::string> words = start.words;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int out = openForWriting(start.out);
  const int err = openForWriting(start.err);
  id_ = fork();
  if (id_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    if (start.inherited >= 0) fcntl(start.inherited, F_SETFD, 0);
    for (const auto& [name, value] : start.environment)
      value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
    if (chdir(start.folder.c_str()) == 0) execvp(pointers[0], pointers.data());
    _exit(127);
  }
  close(out);
  close(err);
  if (id_ < 0) throw std::runtime_error("no process can be started");
}

ChildProcess::~ChildProcess() {
  if (!isRunning()) return;
  kill(id_, SIGKILL);
  waitpid(id_, nullptr, 0);
}

bool ChildProcess::isRunning() {
  int status = 0;
  if (exitCode_ || waitpid(id_, &status, WNOHANG) == 0) return !exitCode_;
  exitCode_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

std::optional<int> ChildProcess::waitForExit(std::chrono::milliseconds atMost) {
  const auto end = std::chrono::steady_clock::now() + atMost;
  while (isRunning() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kChildPoll);
  return exitCode_;
}

namespace {

/// User and system time of a process or a thread, by its folder in /proc.
double secondsOf(const std::string& folder) {
  std::ifstream file(folder + "/stat");
  std::string line;
  std::getline(file, line);
  // The second field is the program's name, which may have spaces; the times are the 14th and 15th.
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

double ChildProcess::processorSeconds() const { return secondsOf(fmt::format("/proc/{}", id_)); }
double ChildProcess::firstThreadSeconds() const { return secondsOf(fmt::format("/proc/{0}/task/{0}", id_)); }

}  // namespace lightvane
