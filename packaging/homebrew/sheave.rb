# Untested formula. From a checkout: brew install --HEAD packaging/homebrew/sheave.rb
class Sheave < Formula
  desc "Simulator of rigid bodies and of cables that run over wheels"
  homepage "https://sheave.invalid"
  license "MIT"
  head "file://#{File.expand_path("../..", __dir__)}", using: :git, branch: "main"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "python@3.12" => :build
  depends_on "eigen"
  depends_on "fmt"
  depends_on "nlohmann-json"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *std_cmake_args,
           "-DSHEAVE_RENDER=OFF", "-DSHEAVE_TESTS=OFF", "-DSHEAVE_BENCH=OFF", "-DSHEAVE_PYTHON=OFF",
           "-DSHEAVE_WARNINGS_AS_ERRORS=OFF"
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
    system "dev/install-pages", "build/tools/sheave", prefix
  end

  test do
    system bin/"sheave", "run", share/"sheave/scenes/paper/simple.json", "--check"
  end
end
