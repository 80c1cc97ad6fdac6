"""The pytest plugin, in a pytest of its own."""
import json

TEST = """
def test_the_board(halfrow_board):
    import halfrow
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
    report = halfrow_board.verify(tables=tables)
    assert halfrow_board.reports == [report]
    assert report.passed
"""


def test_a_passing_test_says_nothing(pytester):
    pytester.makepyfile(TEST)
    result = pytester.runpytest_subprocess("--halfrow-report", "kept", "-rA")
    result.assert_outcomes(passed=1)
    result.stdout.no_fnmatch_line("*halfrow: PASS*")
    assert not (pytester.path / "kept").exists()


def test_a_failing_test_has_the_report_with_it_and_its_files_in_a_folder(pytester):
    pytester.makepyfile(TEST)
    for _ in range(2):
        result = pytester.runpytest_subprocess(
            "--halfrow-board", "mock,fault=stuck-data,bit=7", "--halfrow-report", "kept", "--junitxml", "all.xml"
        )
        result.assert_outcomes(failed=1)
        result.stdout.fnmatch_lines(
            ["*halfrow: FAIL of mock,fault=stuck-data,bit=7*", "FAIL: *data bit 7*", "*Next: *", "report: kept/*"]
        )
    folder = next((pytester.path / "kept").iterdir()) / "0"
    assert sorted(file.name for file in folder.iterdir()) == ["report.html", "report.json", "report.xml"]
    assert json.loads((folder / "report.json").read_text())["verdict"] == "FAIL"


def test_a_report_that_cannot_be_kept_hides_no_failure(pytester):
    pytester.makepyfile(TEST)
    (pytester.path / "kept").write_text("a file")
    result = pytester.runpytest_subprocess("--halfrow-board", "mock,fault=stuck-data", "--halfrow-report", "kept")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["The report is not kept: *"])


def test_a_board_that_cannot_be_opened_fails_the_test_with_its_remedy(pytester):
    pytester.makepyfile(TEST)
    result = pytester.runpytest_subprocess("--halfrow-board", "serial:/dev/none")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*HalfrowError: */dev/none*"])


def test_the_options_are_explained(pytester):
    result = pytester.runpytest_subprocess("--help")
    result.stdout.fnmatch_lines(["*--halfrow-board=TARGET*", "*--halfrow-report=FOLDER*"])
