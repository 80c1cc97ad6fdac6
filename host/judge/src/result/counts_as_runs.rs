//! Counts by row and by column in JSON: `1x5 1079x0` for one 5 and then 1079 zeros, since most counts are equal.

use serde::{Deserialize, Deserializer, Serializer, de};

/// The most counts that are read: frame sizes have 16 bits.
const MOST: usize = 1 << 16;

pub(crate) fn serialize<S: Serializer>(counts: &[u32], serializer: S) -> Result<S::Ok, S::Error> {
    let run = |run: &[u32]| format!("{}x{}", run.len(), run.first().copied().unwrap_or_default());
    let runs: Vec<_> = counts.chunk_by(|a, b| a == b).map(run).collect();
    serializer.serialize_str(&runs.join(" "))
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u32>, D::Error> {
    let text = String::deserialize(deserializer)?;
    let mut counts = Vec::new();
    for run in text.split_whitespace() {
        let pair =
            run.split_once('x').and_then(|(many, count)| Some((many.parse().ok()?, count.parse().ok()?)));
        let Some((many, count)) =
            pair.filter(|&(many, _): &(usize, u32)| counts.len() + many.min(MOST + 1) <= MOST)
        else {
            return Err(de::Error::custom(format!("`{run}` is no run of counts, as 1079x0 is")));
        };
        counts.extend(std::iter::repeat_n(count, many));
    }
    Ok(counts)
}
