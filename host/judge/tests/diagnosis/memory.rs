//! Lines of the line memory.

use crate::bench::{Bench, assert_named, fault, narrow, wide};

#[test]
fn every_data_line_is_named_with_its_level() {
    for (bit, value) in (0..12).flat_map(|bit| [(bit, 0), (bit, 1)]) {
        let place = format!("line memory, data bit {bit}, stuck at {value}");
        assert_named(&narrow(), &format!("stuck-data,bit={bit},value={value}"), &place);
    }
}

#[test]
fn every_address_line_is_named() {
    for bit in 0..7 {
        assert_named(
            &narrow(),
            &format!("stuck-address,bit={bit}"),
            &format!("line memory, address bit {bit}"),
        );
    }
}

#[test]
fn every_address_line_of_a_ring_longer_than_a_row_is_named() {
    for bit in 0..8 {
        assert_named(
            &wide(),
            &format!("stuck-address,bit={bit}"),
            &format!("line memory, address bit {bit}"),
        );
    }
}

/// Both levels make the same addresses share a cell.
#[test]
fn an_address_line_is_named_whatever_its_level() {
    let [low, high] = ["stuck-address,bit=4,value=0", "stuck-address,bit=4,value=1"];
    assert_eq!(wide().diagnose(fault(low)), wide().diagnose(fault(high)));
}

/// In a ring of four rows, the sample that shares the cell comes two rows later.
#[test]
fn an_address_line_that_changes_nothing_is_not_suspected() {
    let bench = Bench { ring: 512, ..narrow() };
    assert_eq!(bench.diagnose(fault("stuck-address,bit=8")), []);
}

#[test]
fn an_address_line_is_named_although_the_ring_did_not_begin_with_the_run() {
    for bit in [0, 3, 5, 6, 7] {
        let bench = Bench { rows_before: 1, ..wide() };
        let suspects = bench.diagnose(fault(&format!("stuck-address,bit={bit}")));
        assert_eq!(suspects[0].place(), format!("line memory, address bit {bit}"), "{suspects:#?}");
        assert_eq!((suspects.len(), suspects[0].explained), (1, 1.0), "{suspects:#?}");
    }
}

#[test]
fn an_address_line_is_named_although_later_frames_were_not_kept() {
    let bench = wide();
    let mut seen = bench.play(Some(fault("stuck-address,bit=6")));
    seen.evidence.retain(|evidence| evidence.index % 2 == 0);
    let suspects = bench.judge(&seen);
    assert_eq!((suspects[0].part(), suspects.len()), ("address bit", 1), "{suspects:#?}");
}
