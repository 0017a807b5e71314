#include "softform/experiment/experiment.hpp"

#include <cmath>
#include <csignal>
#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;

/// Runs a body as the experiment "toy" into a folder of its own.
class ExperimentTest : public testing::Test {
 protected:
  int run(std::vector<std::string> arguments, const std::function<void(softform::Run&)>& body)
  {
    arguments.insert(arguments.begin(), {"toy", "--out", out_.string()});
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    return run_experiment(static_cast<int>(argv.size()), argv.data(), {"toy", "0", "Toys are small.", {1, 2}}, body);
  }
  std::string file(const std::string& name) const { return read_text(out_ / name); }
  nlohmann::json provenance() const { return nlohmann::json::parse(file("provenance.json")); }
  void TearDown() override { fs::remove_all(out_); }

  fs::path out_ = fs::path(testing::TempDir()) /
                  ("softform_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(ExperimentTest, WritesMetricsSeriesAndProvenance)
{
  const int code = run({"--seed", "7", "--threads", "1"}, [](softform::Run& run) {
    run.step("measure");
    run.metric("length", 0.1, "m");
    run.metric("ratio", std::nan(""), "1");
    run.series("trace", {{"k"}, {"energy", "J"}}).add_row({1, 0.5});
    run.dataset("bunny", "abc");
  });
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(file("metrics.csv").starts_with("metric,value,unit\nlength,0.1,m\nratio,nan,1\ntime,"));
  EXPECT_EQ(file("trace.csv"), "k,energy [J]\n1,0.5\n");
  EXPECT_EQ(provenance()["outcome"], "completed");
  EXPECT_EQ(provenance()["size"], "quick");
  EXPECT_EQ(provenance()["seed"], 7);
  EXPECT_EQ(provenance()["threads"], 1);
  EXPECT_EQ(provenance()["datasets"]["bunny"], "abc");
  EXPECT_NE(file("run.log").find("measure"), std::string::npos);
}

TEST_F(ExperimentTest, KnowsItsSize)
{
  EXPECT_EQ(run({"--size", "paper"}, [](softform::Run& run) { run.metric("n", run.by_size(10, 1000), "1"); }), 0);
  EXPECT_NE(file("metrics.csv").find("n,1000,1"), std::string::npos);
  EXPECT_EQ(provenance()["size"], "paper");
}

TEST_F(ExperimentTest, BadInputEndsWith2AndKeepsWhatWasComputed)
{
  const int code = run({}, [](softform::Run& run) {
    run.metric("length", 0.1, "m");
    throw InputError("bunny.obj: open");
  });
  EXPECT_EQ(code, 2);
  EXPECT_NE(file("metrics.csv").find("length,0.1,m"), std::string::npos);
  EXPECT_EQ(provenance()["outcome"], "bad input: bunny.obj: open");
}

TEST_F(ExperimentTest, FailureEndsWith1)
{
  EXPECT_EQ(run({}, [](softform::Run&) { throw std::runtime_error("no luck"); }), 1);
  EXPECT_EQ(provenance()["outcome"], "failed: no luck");
}

TEST_F(ExperimentTest, AMetricComesOnce)
{
  const auto twice = [](softform::Run& run) {
    run.metric("length", 1, "m");
    run.metric("length", 2, "m");
  };
  EXPECT_EQ(run({}, twice), 1);
}

TEST_F(ExperimentTest, UnknownOptionsAndSizesEndWith2)
{
  bool ran = false;
  const auto body = [&](softform::Run&) { ran = true; };
  EXPECT_EQ(run({"--size", "huge"}, body), 2);
  EXPECT_EQ(run({"--sice", "quick"}, body), 2);
  EXPECT_EQ(run({"--threads", "0"}, body), 2);
  EXPECT_FALSE(ran);
}

TEST_F(ExperimentTest, CtrlCEndsBetweenTwoSteps)
{
  // In a process of its own: the flag of Ctrl-C stays raised.
  const auto interrupted_run = [this] {
    const int code = run({}, [](softform::Run& run) {
      run.metric("length", 0.1, "m");
      std::raise(SIGINT);
      run.step("never reached");
      run.metric("width", 0.1, "m");
    });
    const bool kept = file("metrics.csv").find("length") != std::string::npos;
    const bool stopped = file("metrics.csv").find("width") == std::string::npos;
    std::exit(kept && stopped ? code : 1);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(interrupted_run(), testing::ExitedWithCode(130), "interrupted");
}

TEST(TextFile, ReplacesAtomicallyAndNamesWhatFails)
{
  const fs::path folder = fs::path(testing::TempDir()) / "softform_text_file";
  write_text(folder / "a.txt", "one");
  write_text(folder / "a.txt", "two");
  EXPECT_EQ(read_text(folder / "a.txt"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1) << "a temporary file is left";
  EXPECT_THROW(read_text(folder / "missing.txt"), InputError);
  EXPECT_THROW(read_text(folder), InputError);
  EXPECT_THROW(write_text(folder / "a.txt" / "b.txt", "three"), InputError);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace softform
