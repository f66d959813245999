//! Classic control environments with the states, rewards and ends of episodes of Gymnasium 1.4.

mod acrobot;
pub(crate) mod cart_pole;
mod dynamics;
mod mountain_car;
mod mountain_car_continuous;
mod pendulum;
mod pictures;
#[cfg(test)]
mod tests;

pub use acrobot::{Acrobot, AcrobotParams};
pub use cart_pole::{CartPole, CartPoleParams};
pub use dynamics::{Classic, Dynamics, Transition};
pub(crate) use dynamics::{check_length, not_begun};
pub use mountain_car::{MountainCar, MountainCarParams};
pub use mountain_car_continuous::MountainCarContinuous;
pub use pendulum::{Pendulum, PendulumParams};
