//! Check digits of serial numbers.

use serde::{Deserialize, Serialize};
use strum::{Display, VariantArray};

/// How a serial number is protected against misreading. The check digits are at the end of the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Display, VariantArray)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum CheckDigit {
    /// It is not.
    None,
    /// Like ISBN-10 (ISO 2108): the digits, weighted from the last one 1, 2, 3, …, sum to a multiple of 11; the last
    /// may be X for 10. Up to ten digits, because the eleventh would have no weight. What is not a digit is ignored.
    Mod11,
    /// ISO/IEC 7812-1, annex B: every second digit from the right is doubled, and all figures sum to a multiple of 10.
    /// What is not a digit is ignored.
    Luhn,
    /// ISO 7064 MOD 97-10, as in ISO 17442: letters are read as 10 to 35, and the whole number leaves 1 when divided by 97.
    Mod97,
    /// Code 39 (ISO/IEC 16388, annex A): the last character is the sum of the others modulo 43.
    Mod43,
}

/// The characters of Code 39 in the order of their values.
const CODE_39: &str = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ-. $/+%";

impl CheckDigit {
    /// Whether the check digits of `number` are right.
    #[must_use]
    pub fn holds(self, number: &str) -> bool {
        match self {
            Self::None => true,
            Self::Mod11 => mod_11(number),
            Self::Luhn => luhn(number),
            Self::Mod97 => mod_97(number),
            Self::Mod43 => mod_43(number),
        }
    }
}

fn mod_11(number: &str) -> bool {
    let last = number.chars().last().map(|last| if last == 'X' { Some(10) } else { last.to_digit(10) });
    let Some(Some(check)) = last else { return false };
    let rest: Vec<u32> = number.chars().rev().skip(1).filter_map(|digit| digit.to_digit(10)).collect();
    let sum: u32 = check + (2..).zip(&rest).map(|(weight, digit)| weight * digit).sum::<u32>();
    (1..=9).contains(&rest.len()) && sum.is_multiple_of(11)
}

fn luhn(number: &str) -> bool {
    let digits: Vec<u32> = number.chars().rev().filter_map(|digit| digit.to_digit(10)).collect();
    let figures = |(place, &digit): (usize, &u32)| match (place % 2, 2 * digit) {
        (0, _) => digit,
        (_, doubled) => doubled / 10 + doubled % 10,
    };
    let sum: u32 = digits.iter().enumerate().map(figures).sum();
    digits.len() >= 2 && number.ends_with(|last: char| last.is_ascii_digit()) && sum.is_multiple_of(10)
}

fn mod_97(number: &str) -> bool {
    let read = |value: u32, letter: char| match letter {
        '0'..='9' => Some((10 * value + letter.to_digit(10)?) % 97),
        'A'..='Z' => Some((100 * value + letter.to_digit(36)?) % 97),
        _ => None,
    };
    // Two of them are the check digits.
    number.chars().count() >= 3 && number.chars().try_fold(0, read) == Some(1)
}

fn mod_43(number: &str) -> bool {
    let values: Option<Vec<usize>> = number.chars().map(|letter| CODE_39.find(letter)).collect();
    match values.as_deref() {
        Some([rest @ .., check]) if !rest.is_empty() => rest.iter().sum::<usize>() % 43 == *check,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published numbers: an ISBN-10 of Penguin and one with X (Wikipedia, "ISBN"), the example of "Luhn algorithm"
    /// there, a test card of Visa's, the IBANs of the registry for the United Kingdom and Germany (the first four
    /// characters after the others, as ISO 13616 has it), GLEIF's own LEI, and the worked examples of Code 39.
    const WORKED: [(CheckDigit, &str); 11] = [
        (CheckDigit::Mod11, "0306406152"),
        (CheckDigit::Mod11, "080442957X"),
        (CheckDigit::Mod11, "CA-W0-306-40615-2"),
        (CheckDigit::Luhn, "79927398713"),
        (CheckDigit::Luhn, "4111111111111111"),
        (CheckDigit::Luhn, "17893729974"),
        (CheckDigit::Mod97, "WEST12345698765432GB82"),
        (CheckDigit::Mod97, "370400440532013000DE89"),
        (CheckDigit::Mod97, "506700GE1G29325QX363"),
        (CheckDigit::Mod43, "12345ABCDE/T"),
        (CheckDigit::Mod43, "159AZH"),
    ];

    #[test]
    fn published_numbers_hold() {
        for (check, number) in WORKED {
            assert!(check.holds(number), "{check} {number}");
        }
    }

    /// Each of these codes finds every single wrong digit, by its definition.
    #[test]
    fn a_published_number_with_one_digit_changed_does_not() {
        for (check, number) in WORKED {
            for (place, right) in number.char_indices().filter(|(_, letter)| letter.is_ascii_digit()) {
                for wrong in ('0'..='9').filter(|&wrong| wrong != right) {
                    let mut changed = number.to_owned();
                    changed.replace_range(place..=place, &wrong.to_string());
                    assert!(!check.holds(&changed), "{check} {changed}");
                }
            }
        }
    }

    /// Weights that differ by one find transposed neighbours; Luhn finds all but 09 and 90.
    #[test]
    fn nor_with_two_neighbours_exchanged() {
        for (check, number) in WORKED {
            let letters: Vec<char> = number.chars().collect();
            for place in 1..letters.len() {
                let pair = (letters[place - 1], letters[place]);
                let digits = pair.0.is_ascii_digit() && pair.1.is_ascii_digit() && pair.0 != pair.1;
                let is_blind = check == CheckDigit::Mod43 && place + 1 < letters.len();
                if !digits || is_blind || matches!(pair, ('0', '9') | ('9', '0')) {
                    continue;
                }
                let mut swapped = letters.clone();
                swapped.swap(place - 1, place);
                let swapped: String = swapped.into_iter().collect();
                assert!(!check.holds(&swapped), "{check} {swapped}");
            }
        }
    }

    #[test]
    fn what_is_too_short_or_too_long_or_no_number_does_not_hold() {
        for check in CheckDigit::VARIANTS.iter().filter(|&&check| check != CheckDigit::None) {
            for number in ["", "0", "1", "X", "é", "-"] {
                assert!(!check.holds(number), "{check} `{number}`");
            }
        }
        assert!(!CheckDigit::Mod11.holds("50306406152"), "the eleventh digit would weigh nothing");
        assert!(!CheckDigit::Mod97.holds("01"), "two check digits of nothing");
        assert!(CheckDigit::None.holds("anything"));
    }
}
