//! Replacement of the module `recordings` in builds without the feature `ros`.

use std::convert::Infallible;
use std::path::PathBuf;

use clap::{Arg, ArgMatches, Command};
use opendr::Result;
use opendr::learner::{Entry, Outputs};
use opendr::target::Classes;

use crate::item::{Item, Next};
use crate::report::Report;

pub fn flags() -> [Arg; 0] {
    []
}

pub fn ports_by_topic(command: Command, _: &'static Entry) -> Command {
    command
}

pub struct Recordings(Infallible);

impl Recordings {
    pub fn open(
        _: &'static Entry,
        _: &[&PathBuf],
        _: &ArgMatches,
        _: &mut Report<'_>,
    ) -> Result<Option<Self>> {
        Ok(None)
    }

    pub fn len_hint(&self) -> u64 {
        match self.0 {}
    }
}

impl Iterator for Recordings {
    type Item = Next;

    fn next(&mut self) -> Option<Next> {
        match self.0 {}
    }
}

pub struct RecordingSink(Infallible);

impl RecordingSink {
    pub fn new(_: &'static Entry, _: &ArgMatches, _: &[&PathBuf]) -> Result<Option<Self>> {
        Ok(None)
    }

    pub fn begin(&mut self) -> Result<()> {
        match self.0 {}
    }

    pub fn put(&mut self, _: &Item, _: &[Outputs], _: &Classes) -> Result<()> {
        match self.0 {}
    }

    pub fn finish(self) -> Result<()> {
        match self.0 {}
    }
}
