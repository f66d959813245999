//! Measures the errors of predicted actions on held-out episodes of a data set of LeRobot, beside repeating the last action and a linear
//! policy: `offline FOLDER [held-out episodes] [steps] [seed]`.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use opendr_engine::Result;
use opendr_engine::environment::Space;
use opendr_imitation::{
    Act, ActParams, ChunkMethod, ChunkTraining, ChunkTrainingParams, DemonstrationSet, DiffusionParams,
    DiffusionPolicy, read_demonstrations,
};
use opendr_lerobot::LeRobotSet;

/// Actions of a chunk that are executed without observing again.
const OPEN: usize = 16;

fn main() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let number =
        |at: usize, default: u64| given.get(at).and_then(|text| text.parse().ok()).unwrap_or(default);
    let folder = given.first().map_or("data", String::as_str);
    let mut set = LeRobotSet::open(Path::new(folder))?;
    let present: Vec<usize> =
        set.episodes().iter().filter(|record| record.data.exists()).map(|record| record.index).collect();
    let first_held = present.len() - number(1, 10) as usize;
    let (trained, held) = present.split_at(first_held);
    let training_set = read_demonstrations(&mut set, &|index| trained.contains(&index))?;
    let held_set = read_demonstrations(&mut set, &|index| held.contains(&index))?;
    println!(
        "{} episodes with {} steps to train on, {} with {} held out",
        trained.len(),
        training_set.steps(),
        held.len(),
        held_set.steps()
    );
    for every in [1, OPEN] {
        println!("repeating the last action, every {every}: {:.5}", repeated(&held_set, every));
    }
    println!("linear (ridge): {:.5}", linear(&training_set, &held_set));
    let params =
        ChunkTrainingParams { training_steps: number(2, 3_000), seed: number(3, 0), ..Default::default() };
    let one = ActParams::default();
    let open = ActParams { temporal_ensemble: false, n_action_steps: OPEN, ..ActParams::default() };
    chunks::<Act>(&params, [&training_set, &held_set], [&one, &open])?;
    let one = DiffusionParams { n_action_steps: 1, ..DiffusionParams::default() };
    let open = DiffusionParams { n_action_steps: OPEN - 1, ..DiffusionParams::default() };
    chunks::<DiffusionPolicy>(&params, [&training_set, &held_set], [&one, &open])
}

fn chunks<M: ChunkMethod>(
    params: &ChunkTrainingParams,
    [training_set, held_set]: [&DemonstrationSet; 2],
    [one, open]: [&M::Params; 2],
) -> Result<()> {
    let begun = Instant::now();
    let spaces = training_set.row_lengths().map(|width| Space::symmetric(&vec![f32::INFINITY; width]));
    let mut training = ChunkTraining::<M>::new(&M::Config::default(), params, spaces, training_set, None)?;
    training.run(&mut |_, _| ControlFlow::Continue(()))?;
    println!("{}: {:.0} s of training", M::SPEC.name, begun.elapsed().as_secs_f64());
    println!("{}, observing every step: {:.5}", M::SPEC.name, training.policy().action_error(one, held_set)?);
    println!(
        "{}, observing every {OPEN}: {:.5}",
        M::SPEC.name,
        training.policy().action_error(open, held_set)?
    );
    Ok(())
}

/// Returns the mean absolute error of the action before, seen every some steps; the first action of an episode is not counted.
fn repeated(set: &DemonstrationSet, every: usize) -> f64 {
    let [_, width] = set.row_lengths();
    let (mut sum, mut count) = (0.0, 0u64);
    for episode in set.episodes() {
        let row = |step: usize| &episode.actions[step * width..(step + 1) * width];
        for step in 1..episode.actions.len() / width {
            let seen = (step - 1) / every * every;
            let errors = row(step).iter().zip(row(seen)).map(|(own, seen)| f64::from((own - seen).abs()));
            sum += errors.sum::<f64>();
            count += width as u64;
        }
    }
    sum / count as f64
}

/// Returns the mean absolute error of the linear policy of least squares with a small ridge, by normal equations.
fn linear(training_set: &DemonstrationSet, held_set: &DemonstrationSet) -> f64 {
    let [inputs, outputs] = training_set.row_lengths();
    let size = inputs + 1;
    let input = |row: &[f32]| row.iter().map(|&x| f64::from(x)).chain([1.0]).collect::<Vec<_>>();
    let mut equations = vec![vec![0.0; size + outputs]; size];
    for (at, row) in equations.iter_mut().enumerate() {
        row[at] = 1e-3;
    }
    for episode in training_set.episodes() {
        let rows = episode.observations.chunks_exact(inputs).zip(episode.actions.chunks_exact(outputs));
        for (observation, action) in rows {
            let x = input(observation);
            for (at, row) in equations.iter_mut().enumerate() {
                row.iter_mut().zip(&x).for_each(|(sum, other)| *sum += x[at] * other);
                row[size..]
                    .iter_mut()
                    .zip(action)
                    .for_each(|(sum, action)| *sum += x[at] * f64::from(*action));
            }
        }
    }
    // Gauss and Jordan; the matrix is positive definite, so that no pivot is needed.
    for pivot in 0..size {
        let own = equations[pivot].clone();
        for (at, row) in equations.iter_mut().enumerate() {
            let factor = if at == pivot { 1.0 - 1.0 / own[pivot] } else { row[pivot] / own[pivot] };
            row.iter_mut().zip(&own).for_each(|(number, own)| *number -= factor * own);
        }
    }
    let (mut sum, mut count) = (0.0, 0u64);
    for episode in held_set.episodes() {
        let rows = episode.observations.chunks_exact(inputs).zip(episode.actions.chunks_exact(outputs));
        for (observation, action) in rows {
            let x = input(observation);
            for (output, action) in action.iter().enumerate() {
                let predicted: f64 = x.iter().zip(&equations).map(|(x, row)| x * row[size + output]).sum();
                sum += (predicted - f64::from(*action)).abs();
                count += 1;
            }
        }
    }
    sum / count as f64
}
