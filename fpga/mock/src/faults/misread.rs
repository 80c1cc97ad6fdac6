//! Sentences of the pages that whoever made the board has read otherwise.

/// What a board does because a sentence was misread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misread {
    /// It takes the words of the kernel as numbers without a sign.
    UnsignedWeights,
    /// It drops the fraction of the product between two nodes toward zero instead of down.
    WeightsTowardZero,
    /// It adds no half to source coordinates before it drops their last bits.
    UnroundedSource,
    /// It interpolates between the two nodes after the right ones. Beyond the kernel's end its last node stands in.
    NextNode,
    /// Beyond a row's ends it takes the nearest sample, whatever its colour.
    NearestEdge,
    /// It sends the three bytes of every pair of samples in reverse order.
    ReversedPairs,
    /// It reads the bytes of every word of a table in reverse order, whoever asks for them.
    ReversedEntries,
    /// It takes a run of 254 bytes as if a zero followed, so that packets with one come damaged.
    LongRuns,
}

impl Misread {
    /// All of them, by their names.
    pub(crate) const ALL: [Self; 8] = [
        Self::UnsignedWeights,
        Self::WeightsTowardZero,
        Self::UnroundedSource,
        Self::NextNode,
        Self::NearestEdge,
        Self::ReversedPairs,
        Self::ReversedEntries,
        Self::LongRuns,
    ];
    pub(crate) const NAMES: [&str; 8] = [
        "unsigned-weights",
        "weights-toward-zero",
        "unrounded-source",
        "next-node",
        "nearest-edge",
        "reversed-pairs",
        "reversed-entries",
        "long-runs",
    ];
}
