//! Whole tables: stale, early, mixed, or changed during the run.

use crate::bench::{fault, narrow, wide};

#[test]
fn stale_tables_are_named_frame_by_frame() {
    for name in ["stale-table", "stale-table-hidden"] {
        let suspects = narrow().diagnose(fault(name));
        let [only] = &suspects[..] else { panic!("{suspects:#?}") };
        assert_eq!((only.part(), only.explained), ("stale tables", 1.0));
        for clause in [
            "frame 0 made as it went in",
            "frame 1 made with the tables of generation 2 instead of 1",
            "frames 2, 4 to 8 made with the tables of generation 1 instead of 2",
        ] {
            assert!(only.evidence().contains(clause), "{}", only.evidence());
        }
    }
}

/// Row 3 came back right in earlier frames, which were kept.
#[test]
fn a_factor_that_drifts_during_the_run_is_named_with_its_onset() {
    let bench = wide();
    let mut seen = bench.play(Some(fault("drifting-table,after=110,row=3,bit=19")));
    seen.keep_all(bench.sound_frames());
    let suspects = bench.judge(&seen);
    assert_eq!(suspects[0].place(), "row 3's factor, bit 19", "{suspects:#?}");
    assert_eq!((suspects.len(), suspects[0].explained), (1, 1.0));
    assert!(suspects[0].evidence().contains("began during the run"), "{}", suspects[0].evidence());
}

#[test]
fn a_row_that_never_comes_back_is_named() {
    let suspects = narrow().diagnose(fault("lost-row,row=5"));
    assert_eq!((suspects[0].part(), suspects[0].explained), ("lost rows", 1.0));
    assert_eq!(suspects[0].place(), "row 5 on its way out");
}

#[test]
fn a_sound_board_has_no_suspects() {
    for bench in [narrow(), wide()] {
        assert_eq!(bench.judge(&bench.play(None)), []);
    }
}

#[test]
fn faults_that_change_no_sample_have_no_suspects() {
    for name in ["late", "wrong-latency-claim", "wrong-datapath"] {
        assert_eq!(narrow().diagnose(fault(name)), []);
    }
}
