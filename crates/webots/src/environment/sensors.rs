//! Sensors as observations.

use std::collections::BTreeMap;

use opendr_engine::environment::{Dtype, Space};
use opendr_engine::{Error, Result};

use super::options::names;
use crate::kind::DeviceKind;
use crate::link::{DeviceInfo, RobotInfo, WebotsLink};

/// Bytes of a pixel and of a range.
const ELEMENT: usize = 4;
/// Most numbers of one sensor.
const MAX_VALUES: usize = 7;

/// The observed sensors, in the order of their names.
#[derive(Debug, Clone)]
pub(super) struct Sensors {
    sensors: Vec<(usize, DeviceInfo, DeviceKind)>,
}

impl Sensors {
    /// Selects the sensors in `list`; all if it is empty.
    pub fn select(robot: &RobotInfo, list: &str) -> Result<Self> {
        let is_sensor =
            |device: &DeviceInfo| device.kind.is_some_and(|kind| kind.values() > 0 || kind.is_imager());
        let mut chosen = names(list).map(|name| robot.find(name)).collect::<Result<Vec<_>>>()?;
        if chosen.is_empty() {
            chosen = (0..robot.devices.len()).filter(|index| is_sensor(&robot.devices[*index])).collect();
        }
        let mut sensors = Vec::new();
        for index in chosen {
            let device = robot.devices[index].clone();
            match device.kind {
                Some(kind) if is_sensor(&device) => sensors.push((index, device, kind)),
                _ => return Err(device.refused("is not a sensor")),
            }
        }
        sensors.sort_by(|(_, one, _), (_, other, _)| one.name.cmp(&other.name));
        if let Some(pair) = sensors.windows(2).find(|pair| pair[0].1.name == pair[1].1.name) {
            let name = &pair[0].1.name;
            return Err(Error::invalid_param(format!(
                "two observed sensors have the name {name:?}; rename one"
            )));
        }
        if sensors.is_empty() {
            return Err(Error::unsupported(format!("robot {:?} has no sensors to observe", robot.name)));
        }
        Ok(Self { sensors })
    }

    /// Returns the space of observations: one box if all sensors measure numbers, else a dictionary by name.
    pub fn space(&self) -> Result<Space> {
        if self.sensors.iter().all(|(_, _, kind)| !kind.is_imager()) {
            let count = self.sensors.iter().map(|(_, _, kind)| kind.values()).sum();
            return Space::uniform(f32::NEG_INFINITY, f32::INFINITY, &[count]);
        }
        let parts =
            self.sensors.iter().map(|(_, device, kind)| Ok((device.name.clone(), space(device, *kind)?)));
        parts.collect::<Result<BTreeMap<_, _>>>().map(Space::Dict)
    }

    /// Starts all sensors.
    pub fn enable(&self, link: &mut dyn WebotsLink, period_ms: u16) -> Result<()> {
        self.sensors.iter().try_for_each(|(index, _, _)| link.enable(*index, period_ms))
    }

    /// Writes an observation.
    pub fn observe(&self, link: &dyn WebotsLink, mut observation: &mut [f32]) -> Result<()> {
        for (index, device, kind) in &self.sensors {
            let (own, rest) = observation.split_at_mut(length(device, *kind));
            observation = rest;
            if kind.is_imager() {
                let image = link.image(*index)?;
                if image.len() < device.size.0 * device.size.1 * ELEMENT {
                    return Err(silent(device));
                }
                match kind {
                    DeviceKind::Camera => write_colours(image, own),
                    _ => write_ranges(image, device, own),
                }
            } else {
                let mut values = [0.0; MAX_VALUES];
                let values = &mut values[..kind.values()];
                link.values(*index, values)?;
                if values.iter().any(|value| value.is_nan()) {
                    return Err(silent(device));
                }
                for (seen, value) in own.iter_mut().zip(values) {
                    *seen = *value as f32;
                }
            }
        }
        Ok(())
    }

    /// Returns the first camera with its columns and rows.
    pub fn camera(&self) -> Option<(usize, (usize, usize))> {
        let camera = self.sensors.iter().find(|(_, _, kind)| *kind == DeviceKind::Camera)?;
        Some((camera.0, camera.1.size))
    }
}

/// Returns the length of a sensor's part of the observation.
fn length(device: &DeviceInfo, kind: DeviceKind) -> usize {
    let elements = device.size.0 * device.size.1;
    match kind {
        DeviceKind::Camera => 3 * elements,
        kind if kind.is_imager() => elements,
        kind => kind.values(),
    }
}

fn space(device: &DeviceInfo, kind: DeviceKind) -> Result<Space> {
    let (width, height) = device.size;
    match kind {
        DeviceKind::Camera => Space::uniform(0.0, 255.0, &[height, width, 3])?.with_dtype(Dtype::Uint8),
        // What is nearer than the smallest range is measured too, with noise.
        kind if kind.is_imager() => Space::uniform(0.0, device.range.1 as f32, &[height, width]),
        kind => Space::uniform(f32::NEG_INFINITY, f32::INFINITY, &[kind.values()]),
    }
}

/// Converts blue, green, red, alpha to red, green, blue.
fn write_colours(image: &[u8], observation: &mut [f32]) {
    for (seen, [blue, green, red, _]) in
        observation.as_chunks_mut::<3>().0.iter_mut().zip(image.as_chunks().0)
    {
        *seen = [*red, *green, *blue].map(f32::from);
    }
}

/// Nothing within the range is measured as infinity, which becomes the largest range.
fn write_ranges(image: &[u8], device: &DeviceInfo, observation: &mut [f32]) {
    let farthest = device.range.1 as f32;
    for (seen, range) in observation.iter_mut().zip(image.as_chunks().0) {
        *seen = f32::from_le_bytes(*range).clamp(0.0, farthest);
    }
}

fn silent(device: &DeviceInfo) -> Error {
    Error::device(format!(
        "{} {:?} measured nothing in the step; are its sampling period and the scene right?",
        device.kind.map_or("device", DeviceKind::name),
        device.name
    ))
}
