//! `disparity LEFT RIGHT OUT [ROUNDS]`: matches a rectified pair, writes the disparities to `OUT` as 32-bit floats,
//! row by row, and prints the seconds of the fastest round. `benches/stereo.py` compares it with other
//! implementations.

use std::error::Error;
use std::time::Instant;

use opendr_vision::stereo::{StereoMatcher, StereoOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [left, right, out, rest @ ..] = &arguments[..] else {
        return Err("disparity LEFT RIGHT OUT [ROUNDS]".into());
    };
    let rounds: u32 = rest.first().map_or(Ok(1), |rounds| rounds.parse())?;
    let [left, right] = [left, right].map(opendr_vision::open);
    let (left, right) = (left?, right?);
    let mut disparities = vec![0.0; left.width() * left.height()];
    let mut matcher = StereoMatcher::default();
    let mut fastest = f64::INFINITY;
    for _ in 0..rounds.max(1) {
        let begin = Instant::now();
        matcher.run_into(&left, &right, &StereoOptions::default(), &mut disparities)?;
        fastest = fastest.min(begin.elapsed().as_secs_f64());
    }
    let bytes: Vec<u8> = disparities.iter().flat_map(|disparity| disparity.to_le_bytes()).collect();
    std::fs::write(out, bytes)?;
    println!("{fastest}");
    Ok(())
}
