//! The sensor: from light to samples, with the noise of photons and of readout.

use rand_core::Rng;
use rand_pcg::Pcg32;

/// The sample without light, as a share of the largest.
const PEDESTAL: f64 = 0.01;

/// Electrons that a full pixel holds.
const FULL_WELL: f64 = 8000.0;

/// The standard deviation of the readout, in electrons.
const READ_NOISE: f64 = 6.0;

/// The generator's stream, so that the street shares no random numbers with the patterns.
const STREAM: u64 = 56;

/// Steps of the generator that a sample takes.
const STEPS: u64 = 2;

/// A sensor, whose noise continues from pixel to pixel.
pub(super) struct Sensor {
    random: Pcg32,
    max: f64,
}

impl Sensor {
    /// A sensor whose samples go up to `max`, after it has delivered `samples` of them.
    pub(super) fn new(seed: u64, max: u16, samples: usize) -> Self {
        let mut random = Pcg32::new(seed, STREAM);
        random.advance(STEPS * samples as u64);
        Self { random, max: max.into() }
    }

    /// The sample of a pixel that gets `light`, 0 to 1; more saturates.
    pub(super) fn sample(&mut self, light: f64) -> u16 {
        let electrons = light.clamp(0.0, 1.0) * FULL_WELL;
        let deviation = (electrons + READ_NOISE * READ_NOISE).sqrt();
        let measured = (electrons + deviation * self.normal()) / FULL_WELL;
        let share = PEDESTAL + (1.0 - PEDESTAL) * measured;
        (share.clamp(0.0, 1.0) * self.max + 0.5) as u16
    }

    /// A nearly normal number of mean 0 and deviation 1: from the sum of four uniform 16-bit numbers, which is the same on every
    /// machine.
    fn normal(&mut self) -> f64 {
        const UNIT: f64 = 65536.0;
        let bits = self.random.next_u64();
        let sum: u64 = [0, 16, 32, 48].iter().map(|shift| bits >> shift & 0xffff).sum();
        (sum as f64 / UNIT - 2.0) * 3.0_f64.sqrt()
    }
}
