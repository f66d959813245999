/* Calls a learner with two ports, an init port and two outputs by its generated functions: counter MODEL */
#undef NDEBUG
#include <assert.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "opendr_counter.h"

static opendr_image *picture(int64_t stamp_ns) {
    const uint8_t bytes[2][4] = {{1, 2, 0, 0}, {3, 4, 0, 0}};
    opendr_pixels pixels = {bytes, sizeof bytes, 2, 2, 4, OPENDR_U8, OPENDR_GREY, OPENDR_HWC};
    opendr_image *image = NULL;
    assert(opendr_image_create(&pixels, &image) == OPENDR_OK);
    assert(opendr_image_set_stamp(image, stamp_ns) == OPENDR_OK);
    assert(opendr_image_set_frame_id(image, "camera") == OPENDR_OK);
    return image;
}

static float counted(const opendr_bounding_box_list *count) {
    opendr_bounding_box box;
    assert(opendr_bounding_box_list_count(count) == 1);
    assert(opendr_bounding_box_list_get(count, 0, &box) == OPENDR_OK);
    return box.left;
}

struct job {
    const opendr_learner *learner;
    const opendr_image *image;
    const opendr_bounding_box_list *boxes;
};

static void *work(void *given) {
    const struct job *job = (const struct job *)given;
    for (int i = 0; i < 100; i++) {
        opendr_bounding_box_list *count = NULL;
        assert(opendr_infer_counter(job->learner, job->image, job->boxes, NULL, &count, NULL) == OPENDR_OK);
        assert(opendr_bounding_box_list_free(&count) == OPENDR_OK);
    }
    return NULL;
}

int main(int argc, char **argv) {
    opendr_learner *learner = NULL;
    opendr_image *image = picture(7);
    opendr_bounding_box_list *boxes = NULL, *count = NULL;
    opendr_pose_list *poses = NULL;
    opendr_bounding_box items[2] = {{-1, "cat", 0, 0, 1, 1, 0.9f, NULL, 0}, {2, NULL, 0, 0, 1, 1, 0.1f, NULL, 0}};
    opendr_point eye = {3, 4};
    opendr_string *json = NULL;
    int64_t stamp_ns = 0;
    pthread_t threads[2];
    assert(argc == 2);
    items[1].landmarks = &eye;
    items[1].landmark_count = 1;
    assert(opendr_load_counter(argv[1], "cpu", "{\"factor\": 3}", &learner) == OPENDR_OK);
    assert(opendr_bounding_box_list_create(items, 2, &boxes) == OPENDR_OK);

    assert(opendr_infer_counter(learner, image, boxes, NULL, &count, &poses) == OPENDR_INVALID_INPUT);
    assert(strstr(opendr_last_error(), "\"first\"") != NULL && count == NULL && poses == NULL);
    assert(opendr_infer_counter(learner, image, boxes, boxes, &count, &poses) == OPENDR_OK);
    assert(counted(count) == 1 + 2 + 3);
    assert(opendr_pose_list_count(poses) == 0);
    assert(opendr_pose_list_stamp(poses, &stamp_ns) == OPENDR_OK && stamp_ns == 7);
    assert(strcmp(opendr_pose_list_frame_id(poses), "camera") == 0);
    opendr_bounding_box_list_free(&count);
    assert(opendr_set_param(learner, "threshold", "0.05") == OPENDR_OK);
    assert(opendr_infer_counter(learner, image, boxes, NULL, &count, NULL) == OPENDR_OK);
    assert(counted(count) == 1 + 2 + 9);
    assert(opendr_set_param(learner, "factor", "2") == OPENDR_INVALID_PARAM);
    opendr_bounding_box_list_free(&count);

    struct job job = {learner, image, boxes};
    for (int i = 0; i < 2; i++) assert(pthread_create(&threads[i], NULL, work, &job) == 0);
    for (int i = 0; i < 2; i++) assert(pthread_join(threads[i], NULL) == 0);
    assert(opendr_infer_counter(learner, image, boxes, NULL, &count, NULL) == OPENDR_OK);
    assert(counted(count) == 1 + 2 + 3 * (1 + 2 + 400 + 2));
    assert(opendr_reset(learner) == OPENDR_OK);

    assert(opendr_bounding_box_list_to_json(boxes, &json) == OPENDR_OK);
    puts(opendr_string_text(json));
    opendr_bounding_box_list_free(&count);
    assert(opendr_bounding_box_list_from_json(opendr_string_text(json), &count) == OPENDR_OK);
    assert(opendr_bounding_box_list_count(count) == 2);
    opendr_bounding_box_list_free(&count);
    assert(opendr_pose_list_free(&poses) == OPENDR_OK && poses == NULL);
    assert(opendr_pose_list_free(&poses) == OPENDR_OK);
    opendr_string_free(&json);
    opendr_bounding_box_list_free(&boxes);
    opendr_image_free(&image);
    opendr_learner_free(&learner);
    return 0;
}
