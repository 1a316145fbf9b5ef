#include "../../src/compute/source.h"

#include "compute_fixture.h"

namespace wavetank::compute::source_test {
namespace {

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ResolveIncludes, KeepsNamesAndLines) {
  const SourceFiles files{{"main.cl", "int a;\n #  include \"b.cl\"\nint c;\n"}, {"b.cl", "int b;\n"}};
  const std::string text = resolve_includes(files, "main.cl");
  EXPECT_TRUE(contains(text, "#line 1 \"main.cl\"\nint a;\n")) << text;
  EXPECT_TRUE(contains(text, "#line 1 \"b.cl\"\nint b;\n")) << text;
  EXPECT_TRUE(contains(text, "#line 3 \"main.cl\"\nint c;\n")) << text;
}

TEST(ResolveIncludes, WritesAFileOnceAndSurvivesACircle) {
  const SourceFiles files{{"main.cl", "#include \"a.cl\"\n#include \"b.cl\"\n#include \"b.cl\"\n"},
                          {"a.cl", "#include \"b.cl\"\n#include \"a.cl\"\nint a;\n"},
                          {"b.cl", "#include \"a.cl\"\n#include \"main.cl\"\nint b;\n"}};
  const std::string text = resolve_includes(files, "main.cl");
  EXPECT_EQ(count_of(text, "int a;"), 1) << text;
  EXPECT_EQ(count_of(text, "int b;"), 1) << text;
}

TEST(ResolveIncludes, RefusesAnUnknownName) {
  const SourceFiles files{{"main.cl", "\n#include \"a.cl\"\n"}, {"a.cl", "\n\n#include \"weir.cl\"\n"}};
  const std::string error = error_of([&] { resolve_includes(files, "main.cl"); });
  EXPECT_TRUE(contains(error, "a.cl:3: #include \"weir.cl\"")) << error;
  EXPECT_TRUE(contains(error, "a.cl, main.cl")) << error;
  EXPECT_TRUE(contains(error_of([&] { resolve_includes(files, "tide.cl"); }), "\"tide.cl\""));
}

TEST(CompilerErrors, AreReadInTheFormsThatDriversUse) {
  const SourceFiles files{{"sweep.cl", "one\n  two = three;\n"}};
  const auto errors = compiler_errors(
      "warning: something\n"
      "sweep.cl:2:9: error: use of undeclared identifier 'three'\n"
      "error: sweep.cl:1:1: unknown type name 'one'\n"
      "/usr/src/sweep.cl:1:1: fatal error: unknown type name 'one'\n"
      "\"sweep.cl\", line 1: error: identifier \"one\" is undefined\n"
      "input.cl:5:1: error: elsewhere\n",
      files, "#line 1 \"main.cl\"\n#line 1 \"sweep.cl\"\none\n#line 8 \"main.cl\"\nafter\n");
  ASSERT_EQ(errors.size(), 5u);
  EXPECT_EQ(errors[0].file, "sweep.cl");
  EXPECT_EQ(errors[0].line, 2);
  EXPECT_EQ(errors[0].message, "use of undeclared identifier 'three'");
  EXPECT_EQ(errors[1].file, "sweep.cl");
  EXPECT_EQ(errors[1].message, "unknown type name 'one'");
  EXPECT_EQ(errors[2].file, "sweep.cl");
  EXPECT_EQ(errors[2].line, 1);
  EXPECT_EQ(errors[3].message, "identifier \"one\" is undefined");
  EXPECT_EQ(errors[4].file, "main.cl");
  EXPECT_EQ(errors[4].line, 8);
}

TEST(OptionsThatMatter, AreThoseWhoseNamesTheSourceHolds) {
  const std::string source = "#if SLIP\nint FAR_AWAY = TILE_OWN;\n#endif\n";
  EXPECT_EQ(options_that_matter("-DSLIP=1 -DFAR=2 -DTILE_OWN=4 -DCOLE -cl-fast-relaxed-math -D SLIP", source),
            "-DSLIP=1 -DTILE_OWN=4 -cl-fast-relaxed-math -D SLIP");
  EXPECT_EQ(options_that_matter("-DCOLE", source), "");
  EXPECT_EQ(options_that_matter("-DFAR=\"a b\"", source), "-DFAR=\"a b\"") << "quotes are left alone";
}

TEST(DefinitionsThatMatter, AreThoseWhoseNamesTheSourceHolds) {
  const SourceFiles files{
      {"main.cl", "#include \"table.cl\"\n#define OWN 1\nint a[COUNT] = {FIELD_X};\n#define OF(NAME) RATE_##NAME\n// SALT\n"},
      {"table.cl",
       "#define FIELD_X 0  // place, m\n#define FIELD_Y 1\n#define COUNT (LENGTH + 1)\n#define LENGTH 2\n#define RATE_U 3\n"
       "#define SALT 4\n"}};
  const std::string text = definitions_that_matter(resolve_includes(files, "main.cl"));
  EXPECT_TRUE(contains(text, "#define FIELD_X 0  \n#define COUNT (LENGTH + 1)\n#define LENGTH 2\n#define RATE_U 3\n#endif\n")) << text;
  EXPECT_TRUE(contains(text, "#define OWN 1\n")) << "only of tables\n" << text;
  SourceFiles others = files;
  others["table.cl"] = "#define FIELD_W 7\n" + files.at("table.cl") + "#define HEAT 5  // of it\n";
  EXPECT_EQ(definitions_that_matter(resolve_includes(others, "main.cl")), text);
}

TEST(ExplainBuildLog, QuotesTheFirstErrorsOnly) {
  const SourceFiles files{{"sweep.cl", "one\n  two = three;\n"}};
  std::string log;
  for (int i = 0; i < 9; ++i) log += "sweep.cl:2:9: error: number " + std::to_string(i) + "\n  two = three;\n        ^\n";
  const std::string text = explain_build_log(log, files, "");
  EXPECT_TRUE(contains(text, "sweep.cl:2: number 0\n    two = three;\n")) << text;
  EXPECT_FALSE(contains(text, "number 3")) << text;
  EXPECT_TRUE(contains(text, "and 6 more")) << text;
}

TEST(ExplainBuildLog, GivesAnUnknownFormAsItIs) {
  std::string log;
  for (int i = 0; i < 99; ++i) log += "ptxas trouble " + std::to_string(i) + "\n";
  const std::string text = explain_build_log(log, {}, "");
  EXPECT_TRUE(contains(text, "ptxas trouble 0\n")) << text;
  EXPECT_FALSE(contains(text, "ptxas trouble 50")) << text;
  EXPECT_FALSE(explain_build_log("", {}, "").empty());
}

}  // namespace
}  // namespace wavetank::compute::source_test
