//! The figures of the faults that were measured, as the pages give them.

use serde_json::{Value, json};

/// They are counted here from the table itself.
#[test]
fn the_pages_have_the_figures_of_the_faults_that_were_measured() {
    let table = include_str!("../../../host/judge/src/coverage/faults.json");
    let table: Value = serde_json::from_str(table).unwrap();
    let faults = table["faults"].as_array().unwrap();
    let parts = ["at_speed", "corners", "rules", "always"];
    let by_a_part =
        |fault: &&&Value| fault["frames"] != json!([]) || parts.iter().any(|part| fault[part] == true);
    let odd: Vec<_> = faults.iter().skip(1).step_by(2).collect();
    let equal = usize::try_from(table["equivalent"].as_u64().unwrap()).unwrap();
    let found = faults.iter().filter(|fault| fault["whole"] == true).count();
    let share = |found: usize, of: usize| format!("{:.1} %", 100.0 * found as f64 / of as f64);
    let [drawn, all, left] = [faults.len() + equal, faults.len(), faults.len() - found].map(grouped);
    let (whole, halves) =
        (share(found, faults.len()), share(odd.iter().filter(by_a_part).count(), odd.len()));
    let (found, odd) = (grouped(found), odd.len());
    let known = [
        format!("yosys drew {drawn} random single faults"),
        format!("| drawn | {drawn} |\n| proven, by induction, to make no difference | {equal} |\n"),
        format!("| found, of the other {all} | {found}: {whole} |\n| not found | {left} |\n"),
        format!("the remaining {left} faults"),
    ];
    let running = [
        format!("Of the {all} faults"),
        format!("the {odd} at odd places"),
        format!("find {halves} of these {odd} faults"),
        format!("finds {whole} of {all} single faults"),
    ];
    let readme = [format!("by default {whole} of {all}")];
    let pages = [
        (include_str!("../../../docs/how-it-is-known.md"), &known[..]),
        (include_str!("../../../docs/running.md"), &running[..]),
        (include_str!("../../../README.md"), &readme[..]),
    ];
    let missing =
        pages.into_iter().flat_map(|(page, figures)| figures.iter().filter(|figure| !page.contains(*figure)));
    assert_eq!(missing.collect::<Vec<_>>(), [""; 0]);
}

/// The number with a comma before its last three digits.
fn grouped(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", number / 1000, number % 1000) }
}
