//! Random numbers, bit by bit the same on every machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A random number, uniform in `[-1, 1)`, from the upper 53 bits of one number of the stream.
pub fn symmetric(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0
}

/// Random numbers as those of [`symmetric`], the same ones for the same seed.
pub fn numbers(seed: u64) -> impl Iterator<Item = f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    std::iter::repeat_with(move || symmetric(&mut random))
}
