#ifndef OPENDR_OBJECT_DETECTION_2D_NANODET_JIT_H
#define OPENDR_OBJECT_DETECTION_2D_NANODET_JIT_H

/* NanoDet under OpenDR's names; opendr_compat.h explains these headers. */
#include "opendr_utils.h"
#include "target.h"

typedef struct NanodetModel {
    void *network; /* an opendr_learner */
    char *device;
    int **colorList; /* NULL: drawBboxes() has its own colours */
    int numberOfClasses;
    float scoreThreshold;
    int inputSizes[2]; /* as requested; 0 is the trained size */
    int keepRatio;
} NanodetModelT;

/* Loads a model container; modelPath "" or NULL loads the pretrained model. modelName is not used. The model's own size is
 * used: height or width other than 0 prints a warning to stderr. */
static inline void loadNanodetModel(const char *modelPath, const char *modelName, const char *device, float scoreThreshold,
    int height, int width, NanodetModelT *model) {
    opendr_learner *learner = NULL;
    size_t classes = 0;
    char params[64];
    const char *path = modelPath != NULL && modelPath[0] != '\0' ? modelPath : NULL;
    const char *place = device != NULL ? device : "auto";
    (void)modelName;
    memset(model, 0, sizeof *model);
    if (height != 0 || width != 0) fprintf(stderr, "loadNanodetModel: the model's own size is used\n");
    snprintf(params, sizeof params, "{\"threshold\": %g}", (double)scoreThreshold);
    if (opendr_load_nanodet(path, place, params, &learner) != OPENDR_OK) {
        fprintf(stderr, "loadNanodetModel: %s\n", opendr_last_error());
        return;
    }
    opendr_class_count(learner, &classes);
    model->network = learner;
    model->device = (char *)malloc(strlen(place) + 1);
    if (model->device != NULL) strcpy(model->device, place);
    model->numberOfClasses = (int)classes;
    model->scoreThreshold = scoreThreshold;
    model->inputSizes[0] = height;
    model->inputSizes[1] = width;
}

/* Returns the detections, which must be freed with freeDetectionsVector(). */
static inline OpenDRDetectionVectorTargetT inferNanodet(NanodetModelT *model, OpenDRImageT *image) {
    OpenDRDetectionVectorTargetT vector;
    opendr_bounding_box_list *boxes = NULL;
    size_t count;
    if (opendr_infer_nanodet((const opendr_learner *)model->network, (const opendr_image *)image->data, &boxes)
        != OPENDR_OK)
        fprintf(stderr, "inferNanodet: %s\n", opendr_last_error());
    count = boxes != NULL ? opendr_bounding_box_list_count(boxes) : 0;
    if (count == 0) {
        initDetectionsVector(&vector);
    } else {
        vector.startingPointer = (OpenDRDetectionTargetT *)malloc(count * sizeof(OpenDRDetectionTargetT));
        vector.size = vector.startingPointer != NULL ? (int)count : 0;
    }
    for (size_t i = 0; count > 0 && i < (size_t)vector.size; i++) {
        opendr_bounding_box box;
        OpenDRDetectionTargetT *target = &vector.startingPointer[i];
        if (opendr_bounding_box_list_get(boxes, i, &box) != OPENDR_OK) break;
        target->name = (int)box.class_index;
        target->left = box.left;
        target->top = box.top;
        target->width = box.width;
        target->height = box.height;
        target->score = box.confidence;
    }
    opendr_bounding_box_list_free(&boxes);
    return vector;
}

/* Draws the boxes on the image. There is no window: a show other than 1 prints a warning to stderr. */
static inline void drawBboxes(OpenDRImageT *image, NanodetModelT *model, OpenDRDetectionVectorTargetT *vector, int show) {
    opendr_bounding_box_list *boxes = NULL;
    size_t count = vector->size > 0 ? (size_t)vector->size : 0;
    opendr_bounding_box *items = (opendr_bounding_box *)calloc(count > 0 ? count : 1, sizeof *items);
    size_t kept = 0;
    if (items == NULL) return;
    if (show != 1) fprintf(stderr, "drawBboxes: there is no window; save the image with opendr_image_save()\n");
    for (size_t i = 0; i < count; i++) {
        const OpenDRDetectionTargetT *target = &vector->startingPointer[i];
        const char *label = opendr_class_name((const opendr_learner *)model->network, target->name);
        if (target->name < 0) continue;
        items[kept].class_index = label != NULL ? -1 : target->name;
        items[kept].label = label;
        items[kept].left = target->left;
        items[kept].top = target->top;
        items[kept].width = target->width;
        items[kept].height = target->height;
        items[kept].confidence = target->score;
        kept++;
    }
    if (opendr_bounding_box_list_create(items, kept, &boxes) != OPENDR_OK
        || opendr_bounding_box_list_draw(boxes, (opendr_image *)image->data) != OPENDR_OK)
        fprintf(stderr, "drawBboxes: %s\n", opendr_last_error());
    opendr_bounding_box_list_free(&boxes);
    free(items);
}

static inline void freeNanodetModel(NanodetModelT *model) {
    opendr_learner *learner = (opendr_learner *)model->network;
    opendr_learner_free(&learner);
    free(model->device);
    memset(model, 0, sizeof *model);
}

#endif /* OPENDR_OBJECT_DETECTION_2D_NANODET_JIT_H */
