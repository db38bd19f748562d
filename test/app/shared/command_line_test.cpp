// SPDX-License-Identifier: BSD-3-Clause
// What all commands have in common, as a user meets it: help, bad input, output that fails.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/command_test.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

class CommandLine : public CommandTest {};

TEST_F(CommandLine, BadInputIsOneLineAndExitCodeTwo) {
    expectBadInput(plan("--set planner.alpha=1.5"), "planner.alpha: 1.5 is outside [0, 1]");
    expectBadInput(plan("--set planner.alhpa=1"), "did you mean 'planner.alpha'");
    expectBadInput(plan("--set scene.file=nowhere.yaml"), "nowhere.yaml");
    expectBadInput(plan("--set goal=[50,0,2]"), "goal: [50, 0, 2] is outside the bounds");
    expectBadInput(plan("--set noise.initial=[-1,0,0,0,0,0]"), "negative variance");
    expectBadInput(plan("--set camera.hfov=0"), "camera.hfov");
    expectBadInput(plan("", "no_such_config"), "no such file");
    expectBadInput(plan("--no-such-flag"), "no-such-flag");
    expectBadInput(photonav("plan " + config("two_textures") + " --out \"\""), "--out");
    expectBadInput(photonav("map nowhere --out \"\""), "--out");
    expectBadInput(photonav("map " + config("room") + " --every 2"), "--every: not together");
    expectBadInput(photonav("plan"), "config");
    expectBadInput(photonav("fly-away"), "fly-away: no such command");
    expectBadInput(photonav("pln x.yaml"), "pln: no such command, did you mean 'plan'?");
    expectBadInput(photonav("--plan"), "--plan: no such option");
    expectBadInput(photonav(""), "subcommand");
    for (const char* command : {"plan", "sweep", "benchmark", "fly"}) {
        const Execution run = photonav(std::string(command) + " x.yaml --seed abc");
        expectBadInput(run, "photonav: --seed: ");
        expectBadInput(photonav(std::string(command) + " x.yaml --seed 0"), "photonav: --seed: ");
    }
    expectBadInput(photonav("plan --bar"), "--bar: no such option (see photonav plan --help)");
    for (const char* arguments : {"check x.tum --max-sigma nan", "servo x.yaml --gain nan",
                                  "servo x.yaml --duration -nan", "info x.yaml --height nan"}) {
        expectBadInput(photonav(arguments), "nan' is not a number");
    }
    expectBadInput(plan("--audits"), "--audits: no such option, did you mean '--audit'?");
    expectBadInput(photonav("keys planner.kap"), "did you mean 'planner.kappa'?");
    expectBadInput(photonav("report " + folder_.string()), "not a result folder of photonav");
    expectBadInput(
        photonav("info " + config("two_textures") + " --at 1,2 --out " + folder_.string()), "--at");
}

TEST_F(CommandLine, AFolderThatCannotBeWrittenIsRefusedBeforeWork) {
    expectBadInput(photonav("plan " + config("two_textures") + " --out /proc/photonav"), "/proc");
}

TEST_F(CommandLine, OutputThatCannotBeWrittenIsNoSuccess) {
    for (const char* arguments : {"--version", "keys"}) {  // little, and more than a buffer holds
        const Execution run =
            execute(fmt::format("{{ {} {} > /dev/full; }}", PHOTONAV_BINARY, arguments));
        EXPECT_EQ(run.exitCode, 1);
        EXPECT_EQ(run.output, "photonav: standard output cannot be written\n");
    }
}

/// What is opened first would otherwise be standard output: the lock of the result.
TEST_F(CommandLine, AClosedStandardOutputIsNotAFileOfTheResult) {
    const std::string plan = fmt::format("{} plan {} --set planner.vertices=60 --json --out {}",
                                         PHOTONAV_BINARY, config("two_textures"), folder_.string());
    for (int i = 0; i < 2; ++i) {
        const Execution run = execute("{ " + plan + " >&-; }");
        EXPECT_EQ(run.exitCode, 1) << run.output;
        EXPECT_EQ(run.output, "photonav: standard output cannot be written\n");
    }
    EXPECT_EQ(execute(plan).exitCode, 0);
}

TEST_F(CommandLine, AStandardErrorThatCannotBeWrittenChangesNoExitCode) {
    for (const char* end : {"2> /dev/full", "2>&-", ">&- 2>&-"}) {
        for (const char* arguments : {"plan none.yaml", "plan --none"}) {
            const Execution run =
                execute(fmt::format("{{ {} {} {}; }}", PHOTONAV_BINARY, arguments, end));
            EXPECT_EQ(run.exitCode, 2) << arguments << " " << end;
        }
    }
}

/// As by `photonav keys | head`. In `photonav ... 2>&1 | tee`, Ctrl-C ends the reader, too.
TEST_F(CommandLine, AReaderThatEndsEarlyChangesNothingButWhatIsRead) {
    EXPECT_EQ(execute(fmt::format("{{ {{ sleep 0.3; {} keys; echo $? >&2; }} | true; }}",
                                  PHOTONAV_BINARY))
                  .output,
              "141\n");
    EXPECT_EQ(execute(fmt::format("{{ {{ {{ sleep 0.3; {} plan none.yaml; echo $? >&3; }} 2>&1 | "
                                  "true; }} 3>&1; }}",
                                  PHOTONAV_BINARY))
                  .output,
              "2\n");
}

/// From too little for the program to what the command needs. (Libraries may say more.)
TEST_F(CommandLine, TooLittleMemoryIsSaid) {
    constexpr int kNotLoaded = 127;  // by the system's loader
    int refused = 0;
    for (int megabytes = 300; megabytes <= 900; megabytes += 50) {
        const Execution run = execute(fmt::format(
            "{{ ulimit -v {}; OMP_NUM_THREADS=1 {} plan {} --set planner.vertices=60 --quiet "
            "--out {}; }}",
            1000 * megabytes, PHOTONAV_BINARY, config("two_textures"), folder_.string()));
        if (run.exitCode == kNotLoaded || run.exitCode == 0) continue;
        ++refused;
        EXPECT_TRUE(run.exitCode == 1 || run.exitCode == 2) << run.exitCode << " " << run.output;
        EXPECT_NE(run.output.find("photonav: "), std::string::npos) << run.output;
    }
    EXPECT_GT(refused, 0);
}

/// While it prints more than a pipe holds.
TEST_F(CommandLine, AnInterruptAfterTheResultDoesNotDenyIt) {
    const std::string pipe = folder_.string() + ".pipe";
    const std::string result = (folder_ / "result.json").string();
    const Execution run = execute(
        fmt::format("{{ mkfifo {0}; exec 3<>{0}; {1} info {2} --json --out {3} > {0} & "
                    "until [ -f {4} ]; do sleep 0.02; done; sleep 0.2; kill -INT $!; wait $!; }}",
                    pipe, PHOTONAV_BINARY, config("two_textures"), folder_.string(), result));
    fs::remove(pipe);
    EXPECT_EQ(run.exitCode, 130);
    EXPECT_EQ(run.output, "photonav: interrupted after the result was written\n");
    EXPECT_TRUE(fs::exists(result));
}

TEST_F(CommandLine, NumbersOutOfRangeAreSaidWithTheirRange) {
    for (const char* number : {"0", "nan", "many"}) {
        const Execution run =
            photonav("info " + config("two_textures") + " --cells " + std::string(number));
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_NE(
            run.output.find(fmt::format("--cells: '{}' is not a number from 1 to 2000", number)),
            std::string::npos)
            << run.output;
    }
}

TEST_F(CommandLine, ADamagedTextureIsSaidInOneLine) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "a.pgm") << "P5\n64 64\n255\ncut short";
    std::ofstream(folder_ / "a.mtl") << "newmtl a\nmap_Kd a.pgm\n";
    std::ofstream(folder_ / "a.obj")
        << "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 9 0 0\nv 0 9 0\nvt 0 0\n"
           "f 1/1 2/1 3/1\n";
    expectBadInput(plan("--set scene.file=" + (folder_ / "a.obj").string()), "a.pgm: ");
}

TEST_F(CommandLine, HelpHasExamplesAndPages) {
    const Execution run = photonav("--help");
    EXPECT_EQ(run.exitCode, 0);
    for (const char* word : {"plan", "info", "map", "report", "Exit codes", "two_textures.yaml"}) {
        EXPECT_NE(run.output.find(word), std::string::npos) << word;
    }
}

TEST_F(CommandLine, HelpOfACommandIsAboutThatCommand) {
    for (const char* command : {"plan", "keys", "report", "fly"}) {
        const Execution run = photonav(std::string(command) + " --help");
        EXPECT_EQ(run.exitCode, 0);
        EXPECT_EQ(run.output.find("Exit codes"), std::string::npos) << run.output;
    }
}

TEST_F(CommandLine, HelpFitsIntoEightyColumns) {
    std::istringstream all(photonav("--help").output);
    std::vector<std::string> commands{""};
    for (std::string line; std::getline(all, line) && line != "Commands:";) {
    }
    for (std::string line; std::getline(all, line) && !line.empty();) {
        if (line.starts_with("  ") && line[2] != ' ') {
            commands.push_back(line.substr(2, line.find(' ', 2) - 2));
        }
    }
    EXPECT_GT(commands.size(), 10U);
    for (const std::string& command : commands) {
        const Execution help = photonav(command + " --help");
        EXPECT_EQ(help.exitCode, 0) << command;
        std::istringstream lines(help.output);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), 80U) << command << ": " << line;
            EXPECT_FALSE(line.ends_with(' ')) << command << ": " << line;
        }
    }
}

}  // namespace
}  // namespace photonav
