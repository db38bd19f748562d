// SPDX-License-Identifier: BSD-3-Clause
// photonav: signals, errors and exit codes. The commands are in *_command_line.cpp of each folder.
#include <fcntl.h>
#include <fmt/format.h>
#include <ompl/util/Console.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

#include "io/error.hpp"
#include "io/folder_transaction.hpp"
#include "io/image_decoder.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"
#include "io/yaml_reader.hpp"
#include "shared/command_io.hpp"
#include "shared/command_line.hpp"

namespace {

using namespace photonav;

std::atomic<bool> interrupted{false};
std::atomic<double> interruptedAt{0.};
volatile std::sig_atomic_t interruptedBy = 0;
std::atomic<OnInterrupt> reaction{OnInterrupt::finish};  // of the present command
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free &&
              std::atomic<OnInterrupt>::is_always_lock_free);
const Stopwatch running;

constexpr double kSameInterrupt = 0.2;  // [s]

/// The exit code that a shell gives a program that a signal ended.
int exitCodeOf(int signal) { return 128 + signal; }
static_assert(kInterrupted == 128 + SIGINT);

/// Standard error, also while it is closed to decoders of images.
const int standardError = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);

/// A file that is opened later must not take the place of standard output: results would be printed
/// into it. /dev/null is opened for reading, so that printing fails and is reported.
void occupyStandardStreams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
    }
}

/// Writes without a lock or a buffer, as a signal handler must.
void say(std::string_view text) {
    static_cast<void>(!write(standardError, text.data(), text.size()));
}

/// Of a command that is interrupted and writes nothing more.
std::string_view saidWhenEnded() {
    return FolderTransaction::isAnyCommitted() ? "interrupted after the result was written"
                                               : "interrupted before there was any result";
}

/// The first Ctrl-C, SIGTERM as Slurm and systemd send it, SIGHUP of a terminal that is closed, or
/// SIGXCPU lets the command finish its files, or ends it at once where there are none yet; the
/// second one always does. timeout(1) sends its signal twice, to the process and to its group: that
/// is one. A shell that ends sends SIGHUP, and so does the system to what it leaves: that is never
/// a second, nor is SIGXCPU, which the system sends every second beyond a limit of processor time.
/// A command that has not ended a second later says so.
void onInterrupt(int signal) {
    const double now = running.seconds();
    double first = 0.;
    if (!interruptedAt.compare_exchange_strong(first, now)) {
        const bool isOnce = signal == SIGHUP || signal == SIGXCPU;
        const bool isAgain = !isOnce && now - first > kSameInterrupt;
        if (isAgain) std::_Exit(exitCodeOf(signal));
        return;
    }
    interruptedBy = signal;
    interrupted = true;
    if (reaction != OnInterrupt::finishAlways && !WorkingFolder::isAnyOpen()) {
        say("photonav: ");
        say(saidWhenEnded());
        say("\n");
        std::_Exit(exitCodeOf(signal));
    }
    alarm(1);
}

void onAlarm(int /*signal*/) {
    say("photonav: interrupted; finishing the current step and writing the results so far (once "
        "more "
        "to stop at once, which keeps an earlier result as it was)\n");
}

/// Some libraries end the program where they run out of memory while they clean up (Embree).
[[noreturn]] void onTerminate() {
    say("photonav: ended by an error within a library; most often there is too little memory\n");
    std::_Exit(kNoAnswer);
}

/// What the system says of a thread that it does not start names nothing.
std::string reasonOf(const std::exception& error) {
    const auto* system = dynamic_cast<const std::system_error*>(&error);
    const bool isThread =
        system != nullptr && system->code() == std::errc::resource_unavailable_try_again;
    return isThread ? "the system starts no more threads (ulimit -u)" : error.what();
}

std::string withNearest(const std::string& complaint, const std::string& word,
                        const std::vector<std::string>& names) {
    const std::string near = nearestWord(word, names);
    return near.empty() ? complaint : fmt::format("{}, did you mean '{}'?", complaint, near);
}

std::vector<std::string> optionsOf(const CLI::App& parser) {
    std::vector<std::string> names;
    for (const CLI::Option* option : parser.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

/// The message for a wrong command line. It names the unknown word, if there is one.
std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
    const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
    const std::vector<std::string> unknown = app.remaining(true);
    const bool isUnknown =
        code == CLI::ExitCodes::ExtrasError || code == CLI::ExitCodes::RequiredError;
    if (code == CLI::ExitCodes::ArgumentMismatch) {
        const std::string what = error.what();
        const std::size_t end = what.find(": At Most 1 required");
        if (end != std::string::npos) return what.substr(0, end) + ": given twice";
    }
    if (!isUnknown || unknown.empty()) return error.what();
    const std::string& word = unknown.front();
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (word.starts_with('-')) {
        const CLI::App& parser = chosen.empty() ? app : *chosen.front();
        return withNearest(word + ": no such option", word, optionsOf(parser));
    }
    if (!chosen.empty()) return error.what();
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return withNearest(word + ": no such command", word, names);
}

int run(int argc, char** argv) {
    CLI::App app{
        "photonav plans paths on which a camera sees enough texture to be localised.\n"
        "Start with: photonav plan config/two_textures.yaml\n",
        "photonav"};
    app.formatter(helpFormat());
    app.set_help_flag("-h,--help", "print this help");
    app.set_version_flag("--version", PHOTONAV_VERSION, "print the version");
    app.require_subcommand(1);
    Invocation invocation{"photonav", interrupted};
    for (int i = 1; i < argc; ++i) invocation.commandLine += std::string(" ") + argv[i];

    Commands commands;
    for (const auto add : {planCommands, flightCommands, explorationCommands, recordingCommands,
                           comparisonCommands, toolCommands}) {
        for (Command& command : add(app, invocation)) commands.push_back(std::move(command));
    }
    app.footer(  // after the commands, which would inherit it
        "Most commands write a result folder (--out): result.json, figures, report.html\n"
        "and config.yaml, which is complete, so that the run can be repeated.\n"
        "photonav COMMAND --help lists the options of a command, photonav keys lists the\n"
        "keys of a config.\n"
        "Exit codes: 0 done; 1 ran, but found no answer; 2 bad input; 130 stopped by\n"
        "Ctrl-C, 143 by SIGTERM, 129 by SIGHUP, 152 by SIGXCPU, all with the results so\n"
        "far.");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        const auto given = app.get_subcommands();
        const std::string command = given.empty() ? "" : given.back()->get_name() + " ";
        printMessage(fmt::format("{} (see photonav {}--help)", complaint(app, error), command));
        return kBadInput;
    }
    for (const Command& command : commands) {
        if (!command.parser->parsed()) continue;
        reaction = command.onInterrupt;
        const int code = command.run();
        if (code != kInterrupted) return code;
        printMessage(FolderTransaction::isAnyCommitted()
                         ? "interrupted; what was done until then is kept"
                         : "interrupted");
        return exitCodeOf(interruptedBy);
    }
    return kBadInput;
}

/// Whether standard output is a pipe or a socket whose other end was closed, as by head(1).
bool isReaderGone() {
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    return poll(&output, 1, 0) > 0 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

/// SIGHUP stays ignored where it is: nohup(1) ignores it.
void onHangUp() {
    if (std::signal(SIGHUP, onInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

}  // namespace

int main(int argc, char** argv) {
    constexpr const char* kNoOutput = "standard output cannot be written";
    occupyStandardStreams();
    std::set_terminate(onTerminate);
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    std::signal(SIGXCPU, onInterrupt);
    onHangUp();
    std::signal(SIGALRM, onAlarm);
    // Writing fails, and says so. In a pipeline Ctrl-C ends the reader of our messages as well:
    // that must not end us before the results so far are written.
    for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
    ompl::msg::noOutputHandler();
    quietDecoders = true;
    const std::string command = argc > 1 ? argv[1] : "";
    const auto fail = [](int code, std::string_view reason) {
        printMessage(oneLine(reason));
        return code;
    };
    const auto failToPrint = [&] {
        if (!isReaderGone()) return fail(kNoAnswer, kNoOutput);
        return exitCodeOf(interrupted ? int{interruptedBy} : SIGPIPE);
    };
    try {
        const int code = run(argc, argv);
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
        return failToPrint();
    } catch (const InputError& error) {
        return fail(kBadInput, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(kBadInput, error.path1().string() + ": " + error.code().message());
    } catch (const Interrupted&) {
        return fail(exitCodeOf(interruptedBy), saidWhenEnded());
    } catch (const std::bad_alloc&) {
        return fail(kNoAnswer, command + ": needs more memory than there is");
    } catch (const std::exception& error) {
        if (std::ferror(stdout) != 0) return failToPrint();
        return fail(kNoAnswer, command + ": " + reasonOf(error));
    }
}
