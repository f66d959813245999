//! The page of each learner of the registry, made of what is generated from registry and cards: `docs/learners.md`, `docs/models.md`,
//! `docs/ros_topics.md`, the C header, the stubs of Python, and the cards.

use std::collections::BTreeMap;

use super::generated::{Port, declarations, modules, rows_of, sections, topics_of};
use super::predictions::{self, PHOTOGRAPHS, Prediction, Predictions};
use crate::inputs;
use crate::learner_table::{self, Training};
use crate::models::{AccuracyCells, Card, Licence, Variant};
use crate::shell::Result;

/// Folder of the pages on the site.
pub const FOLDER: &str = "learners";

/// The learners in the order of the registry.
pub struct Learners {
    learners: Vec<Learner>,
    /// Header of the tables of models.
    columns: String,
}

/// What a page shows of a learner.
struct Learner {
    name: String,
    class: String,
    task: String,
    /// Words of the registry's table: what `fit` trains on, and whether it loads networks of other tools.
    trains: Training,
    takes_networks: bool,
    about: String,
    /// The sentence with inputs and outputs.
    signature: String,
    inputs: Vec<Port>,
    outputs: Vec<String>,
    /// The tables of its parameters.
    parameters: String,
    /// Rows of its models and topics.
    models: Vec<String>,
    topics: Vec<String>,
    /// Module of the Python class.
    module: String,
    /// C declarations.
    declarations: String,
    card: Card,
}

impl Learners {
    /// Reads the generated files and the cards. Fails with the name of a learner that one of them lacks.
    pub fn read() -> Result<Self> {
        let [parameters, models, topics, header] =
            ["docs/learners.md", "docs/models.md", "docs/ros_topics.md", "bindings/c/include/opendr.h"]
                .map(inputs::text);
        let (parameters, models, topics, header) = (parameters?, models?, topics?, header?);
        let sections = sections(&parameters);
        let modules = modules()?;
        let mut learners = Vec::new();
        for learner_table::Learner { name, class, signature: [task, ..], trains, takes_networks } in
            learner_table::read()?
        {
            let missing = |file: &str| format!("{file} has no {name}; run `cargo xtask generate`");
            let section = sections.get(name.as_str()).ok_or_else(|| missing("docs/learners.md"))?;
            let file = format!("models/{name}.toml");
            let card = Card::parse(&inputs::text(&file)?).map_err(|error| format!("{file}: {error}"))?;
            learners.push(Learner {
                about: section.about.to_owned(),
                signature: section.signature.to_owned(),
                inputs: section.inputs(),
                outputs: section.outputs(),
                parameters: section.tables.join("\n\n"),
                models: rows_of(&models, |cell| {
                    cell == format!("`{name}`") || cell.starts_with(&format!("`{name}/"))
                }),
                topics: topics_of(&topics, &name),
                module: modules.get(&class).ok_or_else(|| missing("bindings/python/python/opendr"))?.clone(),
                declarations: declarations(&header, &name).ok_or_else(|| missing("opendr.h"))?,
                card,
                name,
                class,
                task,
                trains,
                takes_networks,
            });
        }
        let columns = models.lines().skip_while(|line| !line.starts_with("| model |")).take(2);
        Ok(Self { learners, columns: columns.map(|line| format!("{line}\n")).collect() })
    }

    /// Returns the names of the learners that take nothing but an image.
    pub fn of_images(&self) -> Vec<&str> {
        let of_images = self.learners.iter().filter(|learner| {
            let required: Vec<_> = learner.inputs.iter().filter(|port| port.required).collect();
            matches!(required[..], [port] if port.kind == "Image")
        });
        of_images.map(|learner| learner.name.as_str()).collect()
    }

    /// Returns the texts of the pages by their places on the site.
    pub fn pages(&self, predictions: &Predictions) -> BTreeMap<String, String> {
        let page = |learner: &Learner| {
            let prediction = predictions.of(&learner.name);
            (format!("{FOLDER}/{}.md", learner.name), learner.page(prediction, &self.columns))
        };
        let index = (format!("{FOLDER}/index.md"), self.index(predictions));
        self.learners.iter().map(page).chain([index]).collect()
    }

    /// Returns the entries of the navigation: a section for each task.
    pub fn navigation(&self) -> String {
        let mut text = String::new();
        for (task, learners) in self.by_task() {
            text += &format!("      - {}:\n", title(task));
            for Learner { name, .. } in learners {
                text += &format!("          - {name}: {FOLDER}/{name}.md\n");
            }
        }
        text
    }

    fn index(&self, predictions: &Predictions) -> String {
        let mut text = format!(
            "# Learners\n\n{} learners for {} tasks. The page of each has its predictions, models, parameters, and how to call it from every \
             language; [Models](../models.md) compares their accuracy, speed and licences.\n",
            self.learners.len(),
            self.by_task().len()
        );
        for (task, learners) in self.by_task() {
            text += &format!("\n## {}\n\n<div class=\"learners\" markdown>\n\n", title(task));
            for learner in learners {
                text += &learner.entry(predictions.of(&learner.name));
            }
            text += "</div>\n";
        }
        text
    }

    /// Returns the learners of each task, in the order of the registry.
    fn by_task(&self) -> Vec<(&str, Vec<&Learner>)> {
        let mut tasks: Vec<(&str, Vec<&Learner>)> = Vec::new();
        for learner in &self.learners {
            match tasks.iter_mut().find(|(task, _)| *task == learner.task) {
                Some((_, learners)) => learners.push(learner),
                None => tasks.push((&learner.task, vec![learner])),
            }
        }
        tasks
    }
}

impl Learner {
    /// Returns the entry of the index: a link with the first drawing, if there is one, and the sentence.
    fn entry(&self, prediction: Option<&Prediction>) -> String {
        let (name, about) = (&self.name, &self.about);
        let image = match prediction {
            Some(Prediction::Made { .. }) => format!("![]({name}/{}){{ loading=lazy }} ", PHOTOGRAPHS[0].0),
            _ => String::new(),
        };
        format!("[{image}**{name}** {about}]({name}.md)\n\n")
    }

    fn page(&self, prediction: Option<&Prediction>, columns: &str) -> String {
        let mut text = format!("# {}\n\n{}\n\n{}\n\n", self.name, self.about, self.facts());
        text += &self.predictions(prediction);
        text += &format!("## Use it\n\n{}", self.surfaces());
        text += &format!("## Models\n\n{}", self.models(columns));
        text += &format!("## Parameters\n\n{}\n\n{}\n\n", self.signature, self.parameters);
        text += "## ROS topics\n\nOf the node, whose name is that of the learner (`~`); [ROS](../ros.md) describes those that every node has.\n\n";
        text + "| subscribes | message | publishes | message |\n|---|---|---|---|\n" + &self.topics.concat()
    }

    /// Returns the table of what the learner is, with the measurements of its default model.
    fn facts(&self) -> String {
        let trains = match self.trains {
            Training::Data => "on data of your own ([training](../training.md))",
            Training::Environments => {
                "in environments ([reinforcement learning](../reinforcement_learning.md))"
            }
            Training::Nothing if self.takes_networks => {
                "runs your network ([bring your own network](../bring_your_own.md))"
            }
            Training::Nothing => "no",
        };
        let mut rows = vec![
            ("task", title(&self.task)),
            ("Python class", format!("`{}.{}`", self.module, self.class)),
            ("training", trains.to_owned()),
        ];
        match self.card.default_variant() {
            None => rows.push(("default model", "none: to be trained first, or your own".to_owned())),
            Some(variant) => {
                rows.push(("default model", format!("`{}/{}`", self.name, variant.name)));
                rows.extend(Self::measurements(variant));
                rows.push(("licence of the weights", weights_licence(&variant.licence)));
            }
        }
        let rows = rows.iter().map(|(name, value)| format!("| {name} | {value} |\n"));
        format!("| | |\n|---|---|\n{}", rows.collect::<String>())
    }

    /// Returns grade, accuracy, speed and memory of a variant, as far as its card states them.
    fn measurements(variant: &Variant) -> Vec<(&'static str, String)> {
        let mut rows = vec![("grade", format!("[{}](../models.md)", variant.grade_cell()))];
        let AccuracyCells { value, interval, data } = variant.accuracy_cells();
        if !value.is_empty() {
            let interval = if interval.is_empty() { interval } else { format!(" (95 %: {interval})") };
            rows.push(("accuracy", format!("{value}{interval} on {data}")));
        }
        if let Some(speed) = &variant.speed {
            let p50 = speed.p50_ms.map(|ms| format!("p50 {ms} ms"));
            let rate = speed.fps.map(|fps| format!("{fps} per second"));
            let factor = speed.real_time_factor.map(|factor| format!("real-time factor {factor}"));
            let numbers = [rate, factor, p50].into_iter().flatten().collect::<Vec<_>>().join(", ");
            rows.push(("speed", format!("{numbers}; {}", speed.on)));
            rows.push(("peak memory", format!("{} MB", speed.peak_mb)));
        }
        rows
    }

    /// Returns the section of the predictions on photographs; nothing for a learner that was not run.
    fn predictions(&self, prediction: Option<&Prediction>) -> String {
        let name = &self.name;
        match prediction {
            None => String::new(),
            Some(Prediction::Unavailable(error)) => format!(
                "## Predictions\n\nNo predictions are shown: the model was not available where this page was built ({error}).\n\n"
            ),
            Some(Prediction::Made { printed, .. }) => {
                let figures = PHOTOGRAPHS.map(|(photograph, credit)| {
                    format!(
                        "<figure><a href=\"{name}/{photograph}\"><img src=\"{name}/{photograph}\" loading=\"lazy\" \
                         alt=\"Predictions of {name} on {photograph}\"></a><figcaption>{photograph}: {credit}</figcaption></figure>\n"
                    )
                });
                let command = predictions::arguments(name).join(" ");
                let printed: String =
                    printed.lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
                format!(
                    "## Predictions\n\nEvery learner of images is shown on the same three photographs, with its default model and parameters, \
                     whether or not it was trained for them.\n\n<div class=\"predictions\">\n{}</div>\n\n??? example \"What the command prints\"\n\n    \
                     ```console\n    $ opendr {command}\n{printed}    ```\n\n",
                    figures.concat()
                )
            }
        }
    }

    /// Returns how to call the learner, a tab for each surface.
    fn surfaces(&self) -> String {
        let tab = |name: &str, language: &str, code: &str| {
            let code: String =
                code.lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
            format!("=== \"{name}\"\n\n    ```{language}\n{code}    ```\n\n")
        };
        [
            tab("Command", "console", &self.console()),
            tab("Python", "python", &self.python()),
            tab("Rust", "rust", &self.rust()),
            tab("C", "c", &self.declarations),
            tab("ROS", "console", &self.ros()),
        ]
        .concat()
    }

    fn console(&self) -> String {
        let name = &self.name;
        let further: String = self
            .required()
            .skip(1)
            .map(|port| format!(" --{} {}", port.name.replace('_', "-"), file_of(port)))
            .collect();
        let input = self.required().next().map(file_of).unwrap_or_default();
        let draws = self.inputs.iter().any(|port| port.kind == "Image");
        let out = if draws { " --out drawn.png" } else { "" };
        let trained = format!("runs/{name}-DATE/model");
        let mut lines = Vec::new();
        match self.trains {
            Training::Data => lines.push(format!("$ opendr fit {name} DATASET --val-split val")),
            Training::Environments => lines.push(format!("$ opendr fit {name} --env ENVIRONMENT")),
            Training::Nothing => (),
        }
        let model = match (self.card.default_variant(), self.trains) {
            (Some(_), _) => String::new(),
            (None, Training::Nothing) => " --model MODEL".to_owned(),
            (None, _) => format!(" --model {trained}"),
        };
        let infer = format!("$ opendr infer {name}{model} {input}{further}{out}");
        // What can be tried at once comes first.
        lines.insert(if self.card.default_variant().is_some() { 0 } else { lines.len() }, infer);
        lines.push(format!("$ opendr bench {name}{model}"));
        lines.push(format!("$ opendr infer {name} --help"));
        lines.join("\n")
    }

    fn python(&self) -> String {
        let required: Vec<&Port> = self.required().collect();
        let notes: String = required
            .iter()
            .filter(|port| port.kind != "Image")
            .map(|port| format!("# {}: {}\n", port.name, port.kind))
            .collect();
        let given = required.iter().enumerate().map(|(place, port)| {
            let value =
                if port.kind == "Image" { format!("\"{}\"", file_of(port)) } else { port.name.clone() };
            if place == 0 { value } else { format!("{}={value}", port.name) }
        });
        let load = if self.card.default_variant().is_some() { "" } else { "\"model\"" };
        format!(
            "from {} import {}\n\nlearner = {}()\nlearner.load({load})\n{notes}{} = learner.infer({})",
            self.module,
            self.class,
            self.class,
            self.outputs.join(", "),
            given.collect::<Vec<_>>().join(", ")
        )
    }

    fn rust(&self) -> String {
        let name = &self.name;
        let required: Vec<&Port> = self.required().collect();
        let images: String = required
            .iter()
            .filter(|port| port.kind == "Image")
            .map(|port| format!("let {} = opendr::vision::open({:?})?;\n", port.name, file_of(port)))
            .collect();
        let ports = match required[..] {
            [port] => format!("Ports::one(&{})", port.name),
            _ => required.iter().fold("Ports::default()".to_owned(), |ports, port| {
                format!("{ports}.with({:?}, &{})", port.name, port.name)
            }),
        };
        let load = match self.card.default_variant() {
            Some(_) => format!("let mut learner = opendr::learner({name:?})?;"),
            None => format!(
                "let mut learner = opendr::registry().find({name:?})?.make(&ParamMap::new(), Device::Auto)?;\n\
                 learner.load(\"model\".as_ref())?;"
            ),
        };
        format!("{load}\n{images}println!(\"{{:#}}\", learner.infer(&{ports})?);")
    }

    fn ros(&self) -> String {
        let model = if self.card.default_variant().is_some() { "" } else { " --model MODEL" };
        let name = &self.name;
        let topic = if self.inputs.first().is_some_and(|port| port.name == "image") {
            " --image /camera/image_raw"
        } else {
            ""
        };
        format!(
            "$ opendr ros2 run {name}{model}{topic}\n$ opendr ros1 run {name}{model}{topic}\n$ opendr ros2 run {name} --help"
        )
    }

    fn required(&self) -> impl Iterator<Item = &Port> {
        self.inputs.iter().filter(|port| port.required)
    }

    /// Returns the tables of the models: measurements, and descriptions with licences.
    fn models(&self, columns: &str) -> String {
        let mut text = format!("{columns}{}\n", self.models.concat());
        if !self.card.variants.is_empty() {
            text += "| model | description | code | data |\n|---|---|---|---|\n";
        }
        for Variant { name, description, licence, .. } in &self.card.variants {
            let cells = [description, &licence.code, &licence.data].map(|cell| cell.replace('|', "\\|"));
            text += &format!("| `{}/{name}` | {} |\n", self.name, cells.join(" | "));
        }
        text + "\n"
    }
}

/// Returns the licence of the weights, and whether it permits commercial use.
fn weights_licence(licence: &Licence) -> String {
    let commercial = match licence.commercial {
        Some(true) => "commercial use permitted",
        Some(false) => "no commercial use",
        None => "commercial use unknown",
    };
    format!("{}; {commercial}", if licence.weights.is_empty() { "none" } else { &licence.weights })
}

/// Returns the name of a file for an input in an example.
fn file_of(port: &Port) -> String {
    let end = match port.kind.as_str() {
        "Image" => "png",
        "Video" => "mp4",
        "Audio" => "wav",
        "PointCloud" => "bin",
        "Timeseries" | "Observation" | "Vector" => "csv",
        "SkeletonSequence" => "npy",
        // Targets, as lines of JSON.
        _ => "jsonl",
    };
    format!("{}.{end}", port.name)
}

/// Returns the name of a task as a title.
fn title(task: &str) -> String {
    let words = task.replace("_2d", " in 2D").replace("_3d", " in 3D").replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_words() {
        assert_eq!(title("object_detection_2d"), "Object detection in 2D");
    }
}
