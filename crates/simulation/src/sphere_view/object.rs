//! Everyday objects: a carton, a can and a bottle, each with one of five labels on its front. Sides and backs of all labels
//! look alike; colours and proportions differ from instance to instance.

use opendr_engine::{Error, Random, Result};

use super::subject::PRODUCTS;
use super::surface::{Form, bump, mix, step};
use super::{Asset, Subject};
use crate::raycast::Vector;

const LABELS: u32 = 5;

struct Product {
    form: u32,
    label: u32,
    half: Vector,
    /// Of the product, of the label, of what is printed on it.
    colours: [[f32; 3]; 3],
    /// Where on the front the print is, and its size.
    print: [f32; 3],
}

/// The object of a class.
pub(super) fn generate(class: u32, instance: u64) -> Result<Asset> {
    if class >= PRODUCTS {
        return Err(Error::invalid_param(format!(
            "there is no object class {class}; give 0 to {}",
            PRODUCTS - 1
        )));
    }
    let product = Product::new(class, &mut Subject::Object.random(u64::from(class), instance));
    let mut asset = Asset::empty();
    asset.add([16, 72], ([0.0; 3], [1.0, 0.0, 0.0, 0.0]), &product)?;
    Ok(asset)
}

impl Product {
    fn new(class: u32, random: &mut Random) -> Self {
        let form = class / LABELS;
        let wide = random.uniform(0.48, 0.58);
        let half = match form {
            0 => [random.uniform(0.36, 0.44), wide, random.uniform(0.68, 0.76)],
            1 => [wide, wide, random.uniform(0.66, 0.76)],
            _ => [wide, wide, random.uniform(0.86, 0.94)],
        };
        let bright = [(); 3].map(|()| random.uniform(0.6, 0.95));
        let dark = [(); 3].map(|()| random.uniform(0.02, 0.3));
        // The print is dark on bright or bright on dark, so that no colour belongs to a label.
        let [label, print] = if random.chance(0.5) { [bright, dark] } else { [dark, bright] };
        let product = [(); 3].map(|()| random.uniform(0.15, 0.85));
        let print_at = [random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), random.uniform(0.36, 0.42)];
        Self { form, label: class % LABELS, half, colours: [product, label, print], print: print_at }
    }

    fn colour_at(&self, [x, y, z]: Vector) -> [f32; 3] {
        let [product, label, print] = self.colours;
        let front = step(x, 0.05, 0.15);
        let is_label = front * (1.0 - step(z.abs(), 0.44, 0.48)) * (1.0 - step(y.abs(), 0.44, 0.48));
        // Behind: a panel of small print, the same on all.
        let lines = step((z * 40.0).sin(), 0.2, 0.5) * (1.0 - step(z.abs(), 0.3, 0.33)) * step(-x, 0.2, 0.3);
        let back = mix(product, [0.9; 3], 0.5 * lines);
        let printed = self.printed((y - self.print[0]) / self.print[2], (z - self.print[1]) / self.print[2]);
        mix(back, mix(label, print, printed), is_label)
    }

    /// How much of the print there is at a place of the label; the print is within -1..=1.
    fn printed(&self, u: f32, v: f32) -> f32 {
        let inside = |distance: f32| 1.0 - step(distance, -0.04, 0.04);
        let radius = (u * u + v * v).sqrt();
        match self.label {
            0 => inside(radius - 0.8),
            1 => inside((radius - 0.7).abs() - 0.2),
            2 => inside((u.abs().min(v.abs()) - 0.24).max(u.abs().max(v.abs()) - 0.9)),
            3 => inside((u - v).abs().min((u + v).abs()).mul_add(0.7, -0.2).max(u.abs().max(v.abs()) - 0.8)),
            _ => {
                bump([v.abs(), u], [0.55, 0.0], [0.6, 1.6]).min(1.0)
                    * inside((v.abs() - 0.55).abs() - 0.22)
                    * inside(u.abs() - 0.85)
            }
        }
    }
}

impl Form for Product {
    fn radius(&self, direction: Vector) -> f32 {
        let [x, y, z] = std::array::from_fn(|axis| (direction[axis] / self.half[axis]).abs());
        // Superellipsoids of power 8: boxes and cylinders with round edges.
        let eighth = |part: f32| part.powi(2).powi(2).powi(2);
        let round = (x * x + y * y).sqrt();
        match self.form {
            0 => 1.0 / (eighth(x) + eighth(y) + eighth(z)).sqrt().sqrt().sqrt(),
            1 => 1.0 / (eighth(round) + eighth(z)).sqrt().sqrt().sqrt(),
            _ => {
                let body = 1.0 / (eighth(round) + eighth(1.6 * z)).sqrt().sqrt().sqrt();
                // The neck stands on the body: a narrow cylinder upwards.
                let aside = (direction[0].powi(2) + direction[1].powi(2)).sqrt().max(1e-3);
                let neck = (0.19 / aside).min(self.half[2] / direction[2].max(1e-3));
                if direction[2] > 0.5 { body.max(neck) } else { body }
            }
        }
    }

    fn colour(&self, direction: Vector) -> [f32; 3] {
        let radius = self.radius(direction);
        self.colour_at(direction.map(|part| part * radius))
    }
}
