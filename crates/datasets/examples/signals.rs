//! Reads and writes files of signals, tracks and point clouds; used by the Python tests.
//!
//! ```console
//! $ cargo run -p opendr-datasets --example signals -- arrays wfdb ecg/100 out --limit 10
//! $ cargo run -p opendr-datasets --example signals -- convert ucr set ucr out
//! ```

use std::fs;
use std::path::Path;

use opendr_datasets::{
    NpyFile, OpenOptions, Problems, WavEncoding, WriteOptions, find_format, npy_from_values, open,
    open_mot_results, open_wav, open_wfdb_record, wav_from_audio, write_mot_results,
};
use opendr_engine::data::{Image, Pixels};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::{Error, Result, Silent, Value, ValueType};

const USAGE: &str = "arrays FORMAT PATH OUT, convert FORMAT PATH TO OUT, recognise PATH, wav IN OUT ENCODING, npy IN OUT, wfdb RECORD OUT, \
                     or results IN OUT; --split NAME, --target TYPE, --limit N";

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let after = |flag: &str| {
        let at = arguments.iter().position(|argument| argument == flag)?;
        arguments.get(at + 1).map(String::as_str)
    };
    let called = |name: &str| ValueType::ALL.iter().copied().find(|each| each.name() == name);
    let split = after("--split").map(str::to_owned);
    let options = OpenOptions { split: split.clone(), target: after("--target").and_then(called) };
    let limit = after("--limit").and_then(|limit| limit.parse().ok()).unwrap_or(usize::MAX);
    let problems = Problems::strict();
    let dataset = |format: &str, path: &str| open(&ExternalDataset::new(path, format), &options, &problems);
    let words: Vec<&str> =
        arguments.iter().map(String::as_str).take_while(|word| !word.starts_with("--")).collect();
    match words[..] {
        ["arrays", format, path, out] => arrays(&*dataset(format, path)?, Path::new(out), limit),
        ["convert", format, path, to, out] => {
            let written = WriteOptions { split, link: false };
            (find_format(to)?.write)(&*dataset(format, path)?, Path::new(out), &written, &problems, &Silent)
        }
        ["recognise", path] => {
            println!("{}", opendr_datasets::recognise(Path::new(path))?.name);
            Ok(())
        }
        ["wav", from, to, encoding] => {
            let encodings = [WavEncoding::Pcm8, WavEncoding::Pcm16, WavEncoding::Pcm24, WavEncoding::Pcm32];
            let all = encodings.into_iter().chain([WavEncoding::Float32, WavEncoding::Float64]);
            let encoding = all.into_iter().find(|each| format!("{each:?}") == encoding);
            let encoding =
                encoding.ok_or_else(|| Error::invalid_param("unknown encoding; use e.g. Pcm16"))?;
            let audio = open_wav(from)?;
            fs::write(
                format!("{to}.npy"),
                npy_from_values(audio.array().as_slice(), &audio.array().shape())?,
            )?;
            Ok(fs::write(to, wav_from_audio(&audio, encoding)?)?)
        }
        ["npy", from, to] => {
            let array = NpyFile::open(from)?;
            let numbers: Vec<f32> = array.all()?.into_iter().map(|number| number as f32).collect();
            Ok(fs::write(to, npy_from_values(&numbers, array.shape())?)?)
        }
        ["wfdb", record, out] => {
            let record = open_wfdb_record(record)?;
            for one in &record.annotations {
                let symbol = one.symbol().unwrap_or(' ').to_string();
                println!(
                    "{}",
                    serde_json::json!([one.sample, symbol, one.subtype, one.channel, one.number, one.text])
                );
            }
            fs::create_dir_all(out)?;
            let numbers = npy_from_values(record.signals.as_slice(), &record.signals.shape())?;
            fs::write(Path::new(out).join("signals.npy"), numbers)?;
            record.save(out)
        }
        ["results", from, to] => write_mot_results(to, &open_mot_results(from)?),
        _ => Err(Error::invalid_param(USAGE)),
    }
}

/// Prints a line for each sample, and writes `OUT/SAMPLE_DATUM.npy` for each datum that is an array.
fn arrays(dataset: &dyn DatasetIterator, out: &Path, limit: usize) -> Result<()> {
    fs::create_dir_all(out)?;
    let classes: Vec<_> = dataset.classes().iter().map(str::to_owned).collect();
    println!("{}", serde_json::json!({"len": dataset.len(), "classes": classes}));
    for index in 0..dataset.len().min(limit) {
        let sample = dataset.get(index)?;
        for (at, datum) in sample.data.iter().enumerate() {
            let (numbers, shape) = numbers(datum);
            fs::write(out.join(format!("{index:06}_{at}.npy")), npy_from_values(&numbers, &shape)?)?;
        }
        println!(
            "{}",
            serde_json::json!({"name": dataset.name(index), "sequence": dataset.sequence(index), "target": sample.target})
        );
    }
    Ok(())
}

fn numbers(datum: &Value) -> (Vec<f32>, Vec<usize>) {
    match datum {
        Value::Timeseries(series) => (series.as_slice().to_vec(), series.shape().to_vec()),
        Value::Audio(audio) => (audio.array().as_slice().to_vec(), audio.array().shape().to_vec()),
        Value::SkeletonSequence(sequence) => (sequence.as_slice().to_vec(), sequence.shape().to_vec()),
        Value::PointCloud(cloud) => (cloud.as_slice().to_vec(), cloud.shape().to_vec()),
        Value::PointCloudWithCalibration(scan) => {
            (scan.cloud.as_slice().to_vec(), scan.cloud.shape().to_vec())
        }
        Value::Image(image) => pixels(image),
        _ => (Vec::new(), vec![0]),
    }
}

fn pixels(image: &Image) -> (Vec<f32>, Vec<usize>) {
    let numbers = match image.pixels() {
        Pixels::U8(samples) => samples.iter().map(|sample| f32::from(*sample)).collect(),
        Pixels::U16(samples) => samples.iter().map(|sample| f32::from(*sample)).collect(),
        Pixels::F32(samples) => samples.to_vec(),
    };
    (numbers, vec![image.height(), image.width(), image.channels()])
}
