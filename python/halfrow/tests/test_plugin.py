"""The pytest plugin, in a separate pytest."""
import json

import pytest

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
    folder = next((pytester.path / "kept").glob("*/0"))
    assert sorted(file.name for file in folder.iterdir()) == ["report.html", "report.json", "report.xml"]
    assert json.loads((folder / "report.json").read_text())["verdict"] == "FAIL"


def test_a_report_that_cannot_be_kept_hides_no_failure(pytester):
    pytester.makepyfile(TEST)
    (pytester.path / "kept").write_text("a file")
    result = pytester.runpytest_subprocess("--halfrow-board", "mock,fault=stuck-data", "--halfrow-report", "kept")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["The report is not kept: *"])


def test_a_report_that_has_lost_its_run_ends_no_session(pytester):
    pytester.makepyfile("""
import pickle

def test_it(halfrow_board):
    halfrow_board.verify(frames="builtin:bars", at_speed=0)
    halfrow_board.reports[:] = pickle.loads(pickle.dumps(halfrow_board.reports))
    assert False

def test_the_next():
    pass
""")
    result = pytester.runpytest_subprocess("--halfrow-report", "kept")
    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["The report is not kept: the frames of this report's run are not with it*"])


def test_a_board_that_cannot_be_opened_fails_the_test_with_its_remedy(pytester):
    pytester.makepyfile(TEST)
    result = pytester.runpytest_subprocess("--halfrow-board", "serial:/dev/none", "--halfrow-report", "kept")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*HalfrowError: */dev/none*", "*halfrow: ERROR of serial:/dev/none*", "report: kept/*"])
    assert [headline for headline in kept(pytester).values() if "/dev/none" in headline]


FAILING = ("--halfrow-board", "mock,fault=stuck-data,bit=7", "--halfrow-report", "kept")
SMALL = """
import halfrow, os, pathlib, pytest
TABLES = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
def judged(board, **options):
    return board.verify(tables=TABLES, frames="builtin:bars", at_speed=0, **options).passed
"""


def kept(pytester):
    """The reports that are kept: the headline of each, by its folder."""
    folder = pytester.path / "kept"
    read = lambda file: json.loads(file.read_text())["headline"]  # noqa: E731
    return {str(file.parent.relative_to(folder)): read(file) for file in folder.rglob("report.json")}


def named(result):
    """The reports that the tests say are kept."""
    return [line.removeprefix("report: kept/") for line in result.outlines if line.startswith("report: ")]


def test_every_failing_test_has_a_folder_of_its_own(pytester):
    """However similar and however long their names are."""
    cases = ["a/b", "a b", "a+b", "x" * 300, "y" + "x" * 300, "\U00020000" * 300]
    pytester.makepyfile(SMALL + f"""
@pytest.mark.parametrize("case", {cases}, ids={cases})
def test_it(halfrow_board, case):
    assert judged(halfrow_board)
""")
    result = pytester.runpytest_subprocess(*FAILING)
    result.assert_outcomes(failed=len(cases))
    assert len(set(named(result))) == len(cases) and set(named(result)) == set(kept(pytester))


def test_a_report_is_kept_where_it_was_asked_for_wherever_the_test_goes(pytester):
    pytester.makepyfile(SMALL + """
def test_it(halfrow_board, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert judged(halfrow_board)
""")
    result = pytester.runpytest_subprocess(*FAILING)
    result.assert_outcomes(failed=1)
    assert named(result) == list(kept(pytester))


def test_reports_of_an_earlier_run_are_removed_and_nothing_else(pytester):
    pytester.makepyfile(SMALL + """
def test_it(halfrow_board):
    passed = [judged(halfrow_board) for _ in range(int(os.environ["TIMES"]))]
    assert all(passed)
""")

    def run(times, *options):
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("TIMES", str(times))
            return pytester.runpytest_subprocess(*options)

    run(3, *FAILING).assert_outcomes(failed=1)
    assert len(kept(pytester)) == 3
    others = [pytester.path / "kept/notes.txt", next((pytester.path / "kept").glob("*/0")).parent / "notes.txt"]
    [other.write_text("mine") for other in others]
    wrong = pytester.makepyfile(test_wrong="def (")
    for without_tests in (["--collect-only"], ["--setup-plan"], ["--setup-only"], ["--fixtures"], [], ["-k", "none_at_all"]):
        run(1, *FAILING, *without_tests)
        assert len(kept(pytester)) == 3, without_tests
    wrong.unlink()
    run(1, *FAILING, "-k", "none_at_all")
    assert len(kept(pytester)) == 3
    run(1, "--halfrow-board", "mock,fault=stuck-data,bit=3", *FAILING[2:]).assert_outcomes(failed=1)
    assert [headline for headline in kept(pytester).values() if "bit 3" in headline and "bit 7" not in headline]
    assert len(kept(pytester)) == 1
    run(1, *FAILING[2:]).assert_outcomes(passed=1)
    assert not kept(pytester) and [other.read_text() for other in others] == ["mine", "mine"]


def test_a_test_that_is_tried_again_begins_anew(pytester):
    """As pytest-rerunfailures does it."""
    pytester.makeconftest("""
from _pytest.runner import runtestprotocol

def pytest_runtest_protocol(item, nextitem):
    runtestprotocol(item, nextitem=nextitem, log=False)
    for told in runtestprotocol(item, nextitem=nextitem, log=False):
        item.ihook.pytest_runtest_logreport(report=told)
    return True
""")
    pytester.makepyfile(SMALL + """
tries = []

def test_it(halfrow_board):
    tries.append(judged(halfrow_board))
    assert len(halfrow_board.reports) == 1
    assert len(tries) == 2
""")
    pytester.runpytest_subprocess(*FAILING[2:]).assert_outcomes(passed=1)
    assert not kept(pytester)


@pytest.mark.skipif(not hasattr(pytest, "Subtests"), reason="pytest has no subtests before version 9")
@pytest.mark.parametrize(
    "judging, shown",
    [
        # The second subtest passes, and its report is left to the test, which fails after its subtests.
        ("judged(halfrow_board, seed=seed) or seed == 2", ["0", "2", "1", "3"]),
        # A report from before the subtests is about whichever fails.
        ("passed or seed != 2", ["0", "1"]),
    ],
    ids=["judged_by_each", "judged_before"],
)
def test_a_subtest_that_fails_shows_its_own_reports(pytester, judging, shown):
    pytester.makepyfile(SMALL + f"""
def test_it(halfrow_board, subtests):
    passed = {"passed" in judging} and judged(halfrow_board)
    for seed in (1, 2, 3):
        with subtests.test(seed=seed):
            assert {judging}
    assert judged(halfrow_board)
""")
    result = pytester.runpytest_subprocess(*FAILING)
    assert [place.rsplit("/", 1)[1] for place in named(result)] == shown, result.outlines


def test_reports_of_an_earlier_run_are_removed_by_the_session_that_hands_tests_out(pytester):
    """As that of pytest-xdist does, which collects no tests. Before pytest 7 such a session has no list of them either."""
    pytester.makeconftest("""
class Controller:
    def pytest_collection(self, session):
        vars(session).pop("items", None)
        return True

    def pytest_runtestloop(self):
        return True

def pytest_configure(config):
    config.pluginmanager.register(Controller(), "dsession")
""")
    earlier = pytester.path / "kept/a-test/0/report.json"
    earlier.parent.mkdir(parents=True)
    earlier.touch()
    (pytester.path / "kept/.halfrow-kept").write_text("a-test\n")
    result = pytester.runpytest_subprocess(*FAILING)
    assert result.ret == pytest.ExitCode.NO_TESTS_COLLECTED, result.outlines
    assert not earlier.exists()


def test_the_options_are_explained(pytester):
    result = pytester.runpytest_subprocess("--help")
    result.stdout.fnmatch_lines(["*--halfrow-board=TARGET*", "*--halfrow-report=FOLDER*"])
