//! Trains a policy that balances a pole on a cart, by PPO, and draws its learning curve. Needs no input.

use opendr::data::Image;
use opendr::environment::EnvironmentSource as _;
use opendr::params::ParamMap;
use opendr::rl::EvaluationProtocol;
use opendr::{Device, FitEnvironments, FitOptions, Silent, environments, vision};

pub fn main() -> opendr::Result<()> {
    let entry = opendr::registry().find("ppo")?;
    let mut policy = entry.make(&ParamMap::new(), Device::Auto)?;
    let carts = environments::source("CartPole-v1", &ParamMap::new())?;
    let steps = [("total_timesteps", 40_000), ("eval_freq", 4_000), ("n_eval_episodes", 10)];
    let params = steps.map(|(name, steps)| (name.to_owned(), i64::into(steps))).into();
    let options = FitOptions { params, out: Some("train_policy".into()), ..FitOptions::default() };
    let both = FitEnvironments { env: &carts, val_env: None };
    let fitted = opendr::fit_policy(policy.as_mut(), entry, both, &options, &Silent)?;
    let returns = fitted.statistics.curves.get("val_return").cloned().unwrap_or_default();
    let texts: Vec<_> = returns.iter().map(|value| format!("{value:.0}")).collect();
    println!("mean returns: {}", texts.join(", "));
    let protocol = EvaluationProtocol { episodes: 20, ..EvaluationProtocol::default() };
    let result = opendr::evaluate_learner(policy.as_ref(), entry, &mut *carts.make()?, &protocol, &Silent)?;
    println!("after the training {:.0} of 500", result.statistics.get("mean_return").unwrap_or_default());

    // A bar for each evaluation; a pixel is a return of 2.
    let width = 40 * returns.len();
    let mut pixels = vec![255; 250 * width * 3];
    for (index, value) in returns.iter().enumerate() {
        for row in 250 - *value as usize / 2..250 {
            let at = (row * width + 40 * index + 5) * 3;
            pixels[at..at + 90].copy_from_slice(&[[40, 120, 160]; 30].concat());
        }
    }
    vision::save(&Image::from_rgb8(pixels, width, 250)?, "train_policy.png")
}
