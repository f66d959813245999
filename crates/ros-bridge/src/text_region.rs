//! Text regions: `opendr_msgs/TextRegionArray`.

use opendr_engine::Result;
use opendr_engine::target::{TextRegion, TextRegionList};
use opendr_messages::opendr_msgs;

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The regions in reading order.
impl FromToMessage<opendr_msgs::TextRegionArray> for TextRegionList {
    fn from_message(message: opendr_msgs::TextRegionArray, _: &RosBridge) -> Result<Self> {
        let regions = message.regions.into_iter().map(|region| {
            let [ax, ay, bx, by, cx, cy, dx, dy] = region.corners;
            TextRegion::new(region.text, [[ax, ay], [bx, by], [cx, cy], [dx, dy]], region.confidence)
        });
        Ok(Self { header: header_from_message(&message.header), regions: regions.collect(), action: None })
    }

    fn to_message(&self, _: &RosBridge) -> Result<opendr_msgs::TextRegionArray> {
        let regions = self.regions.iter().map(|region| {
            let [[ax, ay], [bx, by], [cx, cy], [dx, dy]] = region.corners;
            let corners = [ax, ay, bx, by, cx, cy, dx, dy];
            opendr_msgs::TextRegion { text: region.text.clone(), confidence: region.confidence, corners }
        });
        Ok(opendr_msgs::TextRegionArray {
            header: message_from_header(&self.header)?,
            regions: regions.collect(),
        })
    }
}
