//! How many single faults are named exactly.

use crate::bench::{Bench, fault, is_told, narrow, off_centre, wide};
use crate::scenes::Random;

/// A random fault as in a target string, and the place that must be named.
fn random_fault(random: &mut Random, height: u64) -> (String, String) {
    let level = random.below(2);
    match random.below(6) {
        0 => {
            let bit = random.below(12);
            let text = format!("stuck-data,bit={bit},value={level}");
            (text, format!("line memory, data bit {bit} stuck at {level}"))
        }
        1 => {
            let bit = random.below(7);
            (format!("stuck-address,bit={bit},value={level}"), format!("line memory, address bit {bit}"))
        }
        2 => {
            let (row, bit) = (random.below(height), random.below(25));
            (format!("row-factor,row={row},bit={bit}"), format!("row {row}'s factor, bit {bit}"))
        }
        3 | 4 => {
            let (node, bit) = (random.below(65), random.below(16));
            let weight = ["g0", "r1", "g4", "r5", "g6"][random.below(5) as usize];
            let text = format!("kernel-word,node={node},weight={weight},bit={bit}");
            (text, format!("kernel node {node}, weight {weight}, bit {bit}"))
        }
        _ => {
            let (tap, other) = (random.below(7), random.below(7));
            let names = ["G0", "R1", "G2", "R3", "G4", "R5", "G6"];
            let [tap_name, other_name] = [tap, other].map(|tap| names[tap as usize]);
            if tap == other {
                return (format!("dead-tap,tap={tap}"), format!("tap {tap_name} stuck at 0"));
            }
            (format!("dead-tap,tap={tap},reads={other}"), format!("tap {tap_name} reading {other_name}"))
        }
    }
}

/// How a number of faults were named.
#[derive(Debug, Default, PartialEq, Eq)]
struct Tally {
    invisible: usize,
    alone: usize,
    first_of_several: usize,
    among_several: usize,
    not_named: usize,
    wrong_for_certain: usize,
}

#[allow(clippy::print_stdout)]
fn tally(faults: u64) -> Tally {
    let mut tally = Tally::default();
    let benches = [narrow(), wide(), off_centre()];
    for seed in 0..faults {
        let bench: &Bench = &benches[(seed % 3) as usize];
        let (text, place) = random_fault(&mut Random::new(seed), bench.geometry.height() as u64);
        let suspects = bench.diagnose(fault(&text));
        let certain = suspects.len() == 1 && suspects[0].explained == 1.0;
        let count = match suspects.iter().position(|suspect| is_told(suspect, &place)) {
            _ if suspects.is_empty() => &mut tally.invisible,
            Some(0) if suspects.len() == 1 => &mut tally.alone,
            Some(0) => &mut tally.first_of_several,
            Some(_) => &mut tally.among_several,
            None if certain => &mut tally.wrong_for_certain,
            None => &mut tally.not_named,
        };
        *count += 1;
        if suspects.first().is_some_and(|first| !is_told(first, &place)) {
            println!("{text}: {suspects:#?}");
        }
    }
    tally
}

#[test]
fn no_wrong_part_is_named_for_certain() {
    let tally = tally(60);
    assert_eq!((tally.wrong_for_certain, tally.not_named), (0, 0), "{tally:?}");
    assert!(tally.alone >= 45, "{tally:?}");
}
