//! Intervals, compared with those of another program and with the closed formula.

use halfrow_station::history::rate::Rate;

/// Count, number and the ends of the interval, by statsmodels 0.15.0 with scipy 1.17.1:
///
/// ```python
/// low, high = statsmodels.stats.proportion.proportion_confint(count, number, 0.05, "wilson")
/// ```
const STATSMODELS: [(u64, u64, f64, f64); 22] = [
    (0, 1, 0.0, 0.7934506856227627),
    (1, 1, 0.2065493143772374, 1.0),
    (0, 3, 0.0, 0.5614970317550455),
    (1, 2, 0.09453120573423068, 0.9054687942657693),
    (2, 3, 0.2076596008020477, 0.9385080552796037),
    (5, 10, 0.23659309051256394, 0.7634069094874361),
    (29, 29, 0.8830302015002592, 1.0),
    (28, 29, 0.8282447812067972, 0.9938867857072375),
    (29, 30, 0.8332960900859081, 0.9940914096183875),
    (30, 30, 0.8864866068260311, 1.0),
    (1, 30, 0.005908590381612455, 0.16670390991409176),
    (97, 100, 0.9154806357094724, 0.9897454759759611),
    (205, 211, 0.9393606976167135, 0.9869037258905047),
    (211, 217, 0.9410001629749887, 0.9872675685221297),
    (450, 500, 0.8705780903680599, 0.9233224372626984),
    (999, 1000, 0.9943574414020421, 0.9998234536293739),
    (1000, 1000, 0.996173241514445, 1.0),
    (1, 1000, 0.00017654637062607765, 0.005642558597957937),
    (7919, 8000, 0.9874340753187211, 0.991845691818854),
    (12345, 20000, 0.6104917957360657, 0.6239631718087776),
    (949321, 1000000, 0.9488893701231476, 0.949749177793876),
    (999999, 1000000, 0.9999943350881957, 0.9999998234754233),
];

#[test]
fn the_interval_is_that_of_statsmodels() {
    for (count, of, low, high) in STATSMODELS {
        let [found_low, found_high] = Rate::new(count, of).interval.unwrap();
        assert!((found_low - low).abs() < 1e-12, "{count} of {of}: {found_low} and not {low}");
        assert!((found_high - high).abs() < 1e-12, "{count} of {of}: {found_high} and not {high}");
    }
}

/// The ends are where the score is ± z: (p̂ − p)² = z² p (1 − p) / n.
#[test]
fn the_score_at_both_ends_is_the_normal_quantile() {
    // scipy.stats.norm.ppf(0.975)
    let z = 1.959963984540054_f64;
    for of in [1, 2, 7, 30, 211, 5000] {
        for count in 0..=of.min(40) {
            let share = count as f64 / of as f64;
            for end in Rate::new(count, of).interval.unwrap() {
                let (left, right) = ((share - end).powi(2), z * z * end * (1.0 - end) / of as f64);
                assert!((left - right).abs() < 1e-12, "{count} of {of}: {left} and {right} at {end}");
            }
        }
    }
}

#[test]
fn nothing_of_nothing_is_no_rate() {
    let rate = Rate::new(0, 0);
    assert_eq!((rate.share, rate.interval, rate.text().as_str()), (None, None, "–"));
    assert_eq!(Rate::new(29, 30).text(), "96.7 % (83.3–99.4)");
}

/// Of [`STATSMODELS`], as text: rounded to as many digits as it takes.
#[test]
fn only_all_are_told_as_all_and_only_none_as_none() {
    for (count, of, told) in [
        (999_999, 1_000_000, "99.9999 % (99.999–99.99998)"),
        (999, 1000, "99.9 % (99.4–99.98)"),
        (1000, 1000, "100.0 % (99.6–100.0)"),
        (1, 1000, "0.1 % (0.02–0.6)"),
        (0, 1, "0.0 % (0.0–79.3)"),
    ] {
        assert_eq!(Rate::new(count, of).text(), told, "{count} of {of}");
    }
}
