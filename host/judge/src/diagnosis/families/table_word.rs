//! A word of a table in each generation, and what one broken cell makes of it.

use crate::result::Reading;
use crate::tables::Generation;

/// The generation, and the word in its tables.
pub(super) type Word = (u8, u32);

/// The possible sets of words that change when `bit` is broken. It may be inverted in every bank or in the bank of one
/// generation, or it may be stuck, so that only the words with the other level change. Equal sets are given once.
pub(super) fn inversions(words: &[Word], bit: u32) -> Vec<Vec<Word>> {
    let is_set = |word: u32| word >> bit & 1 == 1;
    let changed = |broken: &dyn Fn(&Word) -> bool| -> Vec<Word> {
        let inverted = |&(generation, word): &Word| (generation, word ^ 1 << bit);
        words.iter().filter(|word| broken(word)).map(inverted).collect()
    };
    let mut sets =
        vec![changed(&|_| true), changed(&|word| is_set(word.1)), changed(&|word| !is_set(word.1))];
    sets.extend(words.iter().map(|one| changed(&|word| word.0 == one.0)));
    let mut distinct: Vec<Vec<Word>> = Vec::new();
    for set in sets {
        if !set.is_empty() && !distinct.contains(&set) {
            distinct.push(set);
        }
    }
    distinct
}

/// The word of the generation of `uploaded`, if it changed.
pub(super) fn changed(words: &[Word], uploaded: &Generation) -> Option<u32> {
    words.iter().find(|word| word.0 == uploaded.number).map(|word| word.1)
}

/// What is read, and in which generation. `value` gives a word as people write it.
pub(super) fn reading(before: &[Word], after: &[Word], value: impl Fn(u32) -> i64) -> Reading {
    let (generation, read) = after.last().copied().unwrap_or_default();
    let uploaded = before.iter().find(|word| word.0 == generation).map_or(read, |word| word.1);
    let only = after.len() < before.len();
    Reading { uploaded: value(uploaded), read: value(read), generation, only, alike: Vec::new() }
}
