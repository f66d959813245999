//! Rewards, which a supervisor in the world sends as packets.

use opendr_engine::environment::Step;
use opendr_engine::{Error, Result};

use crate::kind::DeviceKind;
use crate::link::{RobotInfo, WebotsLink};

/// Flag of a packet: the task has ended.
const TERMINATED: u8 = 1;
/// Flag of a packet: the episode is cut.
const TRUNCATED: u8 = 2;

/// A receiver of rewards. A packet is a little-endian `f64` and one byte of flags: 1 terminated, 2 truncated.
#[derive(Debug, Clone)]
pub(super) struct Rewards {
    receiver: usize,
    packet: Vec<u8>,
}

impl Rewards {
    /// Selects a receiver.
    pub fn select(robot: &RobotInfo, name: &str) -> Result<Self> {
        let receiver = robot.find(name)?;
        let device = &robot.devices[receiver];
        if device.kind != Some(DeviceKind::Receiver) {
            return Err(device.refused("is not a receiver"));
        }
        Ok(Self { receiver, packet: Vec::new() })
    }

    pub fn enable(&self, link: &mut dyn WebotsLink, period_ms: u16) -> Result<()> {
        link.enable(self.receiver, period_ms)
    }

    /// Drops the packets that wait.
    pub fn clear(&mut self, link: &mut dyn WebotsLink) -> Result<()> {
        while link.receive(self.receiver, &mut self.packet)? {}
        Ok(())
    }

    /// Adds up the packets of a step.
    ///
    /// # Errors
    /// Returns `Device` if none has arrived, `Format` for another packet.
    pub fn step(&mut self, link: &mut dyn WebotsLink) -> Result<Step> {
        let (mut step, mut packets) = (Step::default(), 0u32);
        while link.receive(self.receiver, &mut self.packet)? {
            let Some(([reward @ .., flags], [])) = self.packet.split_first_chunk::<9>() else {
                return Err(Error::format(format!(
                    "a reward of {} bytes; send a little-endian f64 and one byte of flags",
                    self.packet.len()
                )));
            };
            let reward = f64::from_le_bytes(*reward);
            step.reward += reward;
            step.terminated |= flags & TERMINATED != 0;
            step.truncated |= flags & TRUNCATED != 0;
            packets += 1;
        }
        if packets == 0 {
            return Err(Error::device(
                "no reward arrived in the step; the sender must send one in each step",
            ));
        }
        Ok(step)
    }
}
