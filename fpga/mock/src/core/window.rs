//! The window of samples that holds all taps of one output.

/// Samples in the window: columns n − 3 to n + 4, so that the taps for a = n and those for a = n − 1 both fit.
const SAMPLES: usize = 8;

/// Columns of the window left of n.
const LEFT: i32 = 3;

/// Columns of the window right of n. The sample that enters when n moves is the rightmost of them.
const RIGHT: i32 = 4;

/// Taps of an output, G0 to G6.
pub(crate) const TAPS: usize = 7;

/// The eight samples around the source column n. When n moves by one, a new sample replaces the leftmost.
#[derive(Debug)]
pub(crate) struct Window {
    /// Every sample is stored twice, so that all eight always lie side by side, starting with the leftmost.
    samples: [i32; 2 * SAMPLES],
    leftmost: usize,
    n: i32,
}

impl Window {
    /// The window at the start of a row, loaded as a whole. `read` returns the row's sample at a column.
    pub(crate) fn load(n: i32, read: impl Fn(i32) -> u16) -> Self {
        let mut window = Self { samples: [0; 2 * SAMPLES], leftmost: 0, n };
        for column in n - LEFT..=n + RIGHT {
            window.push(read(column));
        }
        window
    }

    /// Moves the window to the source column `n` and reads at most one sample: the port has no time for a second.
    #[inline]
    pub(crate) fn follow(&mut self, n: i32, read: impl Fn(i32) -> u16) {
        if n != self.n {
            self.n = n;
            self.push(read(n + RIGHT));
        }
    }

    #[inline]
    fn push(&mut self, sample: u16) {
        let place = self.leftmost % SAMPLES;
        self.samples[place] = sample.into();
        self.samples[place + SAMPLES] = sample.into();
        self.leftmost = (place + 1) % SAMPLES;
    }

    /// The seven taps G0 to G6 of an output whose base column a is n, or n − 1 if `left_of_n`.
    #[inline]
    pub(crate) fn taps(&self, left_of_n: bool) -> [i32; TAPS] {
        let first = self.leftmost % SAMPLES + usize::from(!left_of_n);
        std::array::from_fn(|tap| self.samples[first + tap])
    }
}
