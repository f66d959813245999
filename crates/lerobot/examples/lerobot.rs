//! Converts a data set of LeRobot to version 3.0, or prints one: `lerobot convert FROM TO`, `lerobot print FOLDER`.

use std::path::Path;

use opendr_engine::{Error, Result};
use opendr_lerobot::{LeRobotSet, convert};

fn main() -> Result<()> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    match given.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["convert", from, to] => {
            let mut set = LeRobotSet::open(Path::new(from))?;
            let info = convert(&mut set, Path::new(to), &|_| true, &mut |_| {})?;
            println!("{} episodes, {} frames", info.total_episodes, info.total_frames);
            Ok(())
        }
        ["print", folder] => print(Path::new(folder)),
        _ => Err(Error::invalid_input("give: convert FROM TO, or: print FOLDER")),
    }
}

/// Prints a line of JSON per episode that is present: index, length, tasks, and the sum of each feature.
fn print(folder: &Path) -> Result<()> {
    let mut set = LeRobotSet::open(folder)?;
    for at in 0..set.episodes().len() {
        let record = set.episodes()[at].clone();
        if !record.data.exists() {
            continue;
        }
        let table = set.read(at, &|_| true)?;
        let sums =
            table.iter().map(|(name, column)| Ok((name.clone(), column.numbers()?.iter().sum::<f64>())));
        let sums = sums.collect::<Result<std::collections::BTreeMap<_, _>>>()?;
        let line = serde_json::json!({
            "episode": record.index, "length": record.length, "tasks": record.tasks, "sums": sums,
        });
        println!("{line}");
    }
    Ok(())
}
