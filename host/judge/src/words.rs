//! Numbers and names for people to read, free of control characters that a terminal would obey.

use std::borrow::Cow;

/// `1 frame`, `16 frames`, `17,280 rows`, `8 tries`.
#[must_use]
pub fn count(number: impl Copy + ToString, what: &str) -> String {
    let number = grouped(number);
    match what.strip_suffix('y').filter(|stem| !stem.ends_with(['a', 'e', 'o'])) {
        _ if number == "1" => format!("{number} {what}"),
        Some(stem) => format!("{number} {stem}ies"),
        None => format!("{number} {what}s"),
    }
}

/// The verb that follows a count of things, from its `plural`: `differs` or `differ`, `is` or `are`.
#[must_use]
pub fn verb(number: impl Copy + ToString, plural: &str) -> Cow<'_, str> {
    match plural {
        _ if number.to_string() != "1" => plural.into(),
        "are" => "is".into(),
        "were" => "was".into(),
        "have" => "has".into(),
        regular => format!("{regular}s").into(),
    }
}

/// How many of `all` things of a kind differ: `1 of 24 samples differs`.
#[must_use]
pub(crate) fn differ_of(number: impl Copy + ToString, all: impl Copy + ToString, what: &str) -> String {
    format!("{} of {} {}", grouped(number), count(all, what), verb(number, "differ"))
}

/// A number with a comma before every third digit from the right.
#[must_use]
pub fn grouped(number: impl Copy + ToString) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Bytes in the largest decimal unit that leaves a whole digit.
#[must_use]
pub fn bytes(number: u64) -> String {
    match number {
        0..1_000 => format!("{number} B"),
        1_000..999_950 => format!("{:.1} kB", number as f64 / 1e3),
        999_950..999_950_000 => format!("{:.1} MB", number as f64 / 1e6),
        _ => format!("{:.1} GB", number as f64 / 1e9),
    }
}

/// A share of 0 to 1 as a percentage; anything short of the whole is at most 99.9 %.
#[must_use]
pub fn percent(share: f64) -> String {
    match share * 100.0 {
        all if all >= 100.0 => "100 %".to_owned(),
        none if none <= 0.0 => "0 %".to_owned(),
        most if most > 99.9 => "99.9 %".to_owned(),
        least if least < 0.1 => "under 0.1 %".to_owned(),
        some => format!("{some:.1} %"),
    }
}

/// A frequency in the largest unit that leaves a whole digit: `96.0 MHz`.
#[must_use]
pub fn hertz(frequency: u32) -> String {
    match frequency {
        0..1_000 => format!("{frequency} Hz"),
        1_000..999_950 => format!("{:.1} kHz", f64::from(frequency) / 1e3),
        _ => format!("{:.1} MHz", f64::from(frequency) / 1e6),
    }
}

/// A time in the two largest units that it has: `3.0 s`, `13 min 20 s`, `6 h 48 min`.
#[must_use]
pub fn span(seconds: f64) -> String {
    // NaN becomes 0 here and is written as `NaN s`.
    let whole = seconds.round().max(0.0) as u64;
    match whole {
        0..60 if seconds > 0.0 && seconds < 999.95e-6 => format!("{:.1} µs", seconds * 1e6),
        0..60 if seconds < 999.95e-3 => format!("{:.1} ms", seconds.max(0.0) * 1e3),
        0..60 => format!("{seconds:.1} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", grouped(whole / 3600), whole % 3600 / 60),
    }
}

/// What a board calls itself.
#[must_use]
pub fn board_name(name: &str) -> Cow<'_, str> {
    if name.trim().is_empty() { Cow::Borrowed("unnamed") } else { plain(name) }
}

/// Text from outside with its control characters escaped: names of boards and files can hold any, and terminals obey
/// some.
#[must_use]
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unfit) {
        return Cow::Borrowed(text);
    }
    let spelt =
        |letter: char| if is_unfit(letter) { letter.escape_default().to_string() } else { letter.into() };
    Cow::Owned(text.chars().map(spelt).collect())
}

/// Each of `lines` as [`plain`] spells it, so that none of them begins another, whatever names it holds.
pub fn plain_lines<Line: AsRef<str>>(lines: impl IntoIterator<Item = Line>) -> String {
    lines.into_iter().map(|line| plain(line.as_ref()).into_owned()).collect::<Vec<_>>().join("\n")
}

/// Whether a terminal may obey `letter`, or text with it may read as another: control characters, line separators, noncharacters and
/// the marks of text direction.
#[must_use]
pub fn is_unfit(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{fffe}' | '\u{ffff}' | '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// `words` as a sentence of its own, with a capital and a full stop; none if there are no words.
#[must_use]
pub fn sentence(words: &str) -> Option<String> {
    let mut letters = words.trim().trim_end_matches('.').chars();
    let first = letters.next()?;
    Some(format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_never_sees_a_control_character() {
        assert_eq!(plain("a\u{1b}[2Jb\u{9b}\n"), "a\\u{1b}[2Jb\\u{9b}\\n");
        assert_eq!(plain("\u{202e}evil"), "\\u{202e}evil");
        assert!(matches!(plain("façade.pgm"), Cow::Borrowed(_)));
    }

    #[test]
    fn a_name_begins_no_line_of_its_own() {
        assert_eq!(plain_lines(["wrote a\nPASS", "b"]), "wrote a\\nPASS\nb");
    }

    #[test]
    fn every_third_digit_is_set_off() {
        let numbers = [0, 12, 999, 1_000, 33_177_600].map(grouped);
        assert_eq!(numbers, ["0", "12", "999", "1,000", "33,177,600"]);
    }

    #[test]
    fn one_thing_is_told_as_one() {
        let told = |number, what| format!("{} {}", count(number, what), verb(number, "differ"));
        assert_eq!([told(1, "frame"), told(0, "frame")], ["1 frame differs", "0 frames differ"]);
        assert_eq!([told(1, "entry"), told(2_000, "entry")], ["1 entry differs", "2,000 entries differ"]);
        assert_eq!(count(2, "day"), "2 days");
        assert_eq!(["are", "were", "have"].map(|plural| verb(1, plural)), ["is", "was", "has"]);
    }

    #[test]
    fn a_time_is_told_in_two_units() {
        let spans = [0.000_032, 0.0216, 3.0, 800.0, 24_480.0, 4_000_000.0].map(span);
        assert_eq!(spans, ["32.0 µs", "21.6 ms", "3.0 s", "13 min 20 s", "6 h 48 min", "1,111 h 6 min"]);
    }

    #[test]
    fn no_number_is_rounded_to_a_thousand_of_its_unit() {
        assert_eq!(
            [999_949, 999_950, 999_949_999, 999_950_000].map(bytes),
            ["999.9 kB", "1.0 MB", "999.9 MB", "1.0 GB"]
        );
        assert_eq!([999_949, 999_950].map(hertz), ["999.9 kHz", "1.0 MHz"]);
        assert_eq!([0.000_999_96, 0.999_96, 59.96].map(span), ["1.0 ms", "1.0 s", "1 min 0 s"]);
    }

    #[test]
    fn a_share_short_of_the_whole_is_never_called_the_whole() {
        let shares = [0.0, 0.000_01, 0.5, 0.999_99, 1.0].map(percent);
        assert_eq!(shares, ["0 %", "under 0.1 %", "50.0 %", "99.9 %", "100 %"]);
    }
}
