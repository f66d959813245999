#include <opendr.h>

/*
 * CounterLearner: Counts boxes.
 *
 * Parameters:
 *   threshold (a float 0..=1, live, default 0.5): Boxes below this score are dropped.
 *   factor (an int 1..=9, default 2): Factor of the count.
 *
 * Inputs:
 *   image (Image): An image.
 *   detections (BoundingBoxList): The detections to count.
 *   first (BoundingBoxList): Boxes whose number is the initial count. Given in the first call of a stream, otherwise NULL.
 *
 * Outputs:
 *   count (BoundingBoxList): One box whose left edge is the count.
 *   poses (PoseList): An empty list.
 */
static inline opendr_status opendr_load_counter(const char *path, const char *device, const char *params_json,
    opendr_learner **learner) {
    return opendr_load("counter", path, device, params_json, learner);
}

static inline opendr_status opendr_infer_counter(const opendr_learner *learner,
    const opendr_image *image,
    const opendr_bounding_box_list *detections,
    const opendr_bounding_box_list *first,
    opendr_bounding_box_list **count,
    opendr_pose_list **poses) {
    opendr_input inputs_[3];
    opendr_output outputs_[2];
    opendr_status status_;
    inputs_[0].name = "image";
    inputs_[0].value = (const opendr_value *)image;
    inputs_[1].name = "detections";
    inputs_[1].value = (const opendr_value *)detections;
    inputs_[2].name = "first";
    inputs_[2].value = (const opendr_value *)first;
    outputs_[0].name = "count";
    outputs_[0].value = NULL;
    outputs_[1].name = "poses";
    outputs_[1].value = NULL;
    status_ = opendr_infer(learner, inputs_, 3, outputs_, 2);
    if (count != NULL) *count = (opendr_bounding_box_list *)outputs_[0].value;
    else opendr_value_free(&outputs_[0].value);
    if (poses != NULL) *poses = (opendr_pose_list *)outputs_[1].value;
    else opendr_value_free(&outputs_[1].value);
    return status_;
}
