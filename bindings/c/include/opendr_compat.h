#ifndef OPENDR_COMPAT_H
#define OPENDR_COMPAT_H

/*
 * OpenDR 3.0's own names over opendr.h, for programs that were written for its C API. The names are frozen. docs/c.md has
 * a table of them. As there, functions that load print what went wrong to stderr and leave NULL behind.
 *
 * Memory: loadX() allocates, freeX() of the same name frees and makes NULL; what inferX() answers is freed by
 * freeDetectionsVector(). loadTensor(), loadDetectionsVector() and loadTensorVector() copy what they are given. Texts that
 * jsonGetX() answer live until its next call in the thread.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "opendr.h"

typedef struct OpenDRImage {
    void *data; /* an opendr_image */
} OpenDRImageT;

typedef struct OpenDRTensor {
    int batchSize, frames, channels, width, height;
    float *data;
} OpenDRTensorT;

typedef struct OpenDRTensorVector {
    int nTensors;
    int *batchSizes, *frames, *channels, *widths, *heights;
    float **datas;
} OpenDRTensorVectorT;

typedef struct OpenDRCategoryTarget {
    int data;
    float confidence;
} OpenDRCategoryTargetT;

typedef struct OpenDRDetectionTarget {
    int name;
    float left, top, width, height, score;
} OpenDRDetectionTargetT;

typedef struct OpenDRDetectionVectorTarget {
    OpenDRDetectionTargetT *startingPointer;
    int size;
} OpenDRDetectionVectorTargetT;

typedef struct NanodetModel {
    void *network; /* an opendr_learner */
    char *device;
    int **colorList; /* NULL: drawBboxes() has colours of its own */
    int numberOfClasses;
    float scoreThreshold;
    int inputSizes[2]; /* as asked for; 0 is the trained size */
    int keepRatio;
} NanodetModelT;

/* Values out of the JSON of a model. */

static inline const char *jsonGetStringFromKey(const char *json, const char *key, int index) {
    return opendr_json_text(json, NULL, key, index);
}

static inline float jsonGetFloatFromKey(const char *json, const char *key, int index) {
    return (float)opendr_json_number(json, NULL, key, index);
}

static inline const char *jsonGetStringFromKeyInInferenceParams(const char *json, const char *key, int index) {
    return opendr_json_text(json, "inference_params", key, index);
}

static inline float jsonGetFloatFromKeyInInferenceParams(const char *json, const char *key, int index) {
    return (float)opendr_json_number(json, "inference_params", key, index);
}

/* Pictures. */

static inline void loadImage(const char *path, OpenDRImageT *image) {
    opendr_image *opened = NULL;
    if (opendr_image_open(path, &opened) != OPENDR_OK) fprintf(stderr, "loadImage: %s\n", opendr_last_error());
    image->data = opened;
}

static inline void freeImage(OpenDRImageT *image) {
    opendr_image *opened = (opendr_image *)image->data;
    opendr_image_free(&opened);
    image->data = NULL;
}

/* Detections; an empty vector has one detection with the name -1. */

static inline void loadDetectionsVector(OpenDRDetectionVectorTargetT *vector, OpenDRDetectionTargetT *detections,
    int count) {
    size_t size = (size_t)(count > 0 ? count : 0) * sizeof *detections;
    vector->startingPointer = (OpenDRDetectionTargetT *)malloc(size > 0 ? size : 1);
    vector->size = vector->startingPointer == NULL || count < 0 ? 0 : count;
    if (vector->size > 0) memcpy(vector->startingPointer, detections, size);
}

static inline void initDetectionsVector(OpenDRDetectionVectorTargetT *vector) {
    OpenDRDetectionTargetT none = {-1, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    loadDetectionsVector(vector, &none, 1);
}

static inline void freeDetectionsVector(OpenDRDetectionVectorTargetT *vector) {
    free(vector->startingPointer);
    vector->startingPointer = NULL;
    vector->size = 0;
}

/* Tensors. */

static inline void initTensor(OpenDRTensorT *tensor) {
    memset(tensor, 0, sizeof *tensor);
}

static inline void freeTensor(OpenDRTensorT *tensor) {
    free(tensor->data);
    initTensor(tensor);
}

static inline void loadTensor(OpenDRTensorT *tensor, void *data, int batchSize, int frames, int channels, int width,
    int height) {
    const int sides[5] = {batchSize, frames, channels, width, height};
    size_t count = 1;
    initTensor(tensor);
    for (int i = 0; i < 5; i++) {
        if (sides[i] <= 0 || count > SIZE_MAX / sizeof(float) / (size_t)sides[i]) {
            fprintf(stderr, "loadTensor: sizes are positive and fit in memory\n");
            return;
        }
        count *= (size_t)sides[i];
    }
    tensor->data = (float *)malloc(count * sizeof(float));
    if (tensor->data == NULL) return;
    memcpy(tensor->data, data, count * sizeof(float));
    tensor->batchSize = batchSize;
    tensor->frames = frames;
    tensor->channels = channels;
    tensor->width = width;
    tensor->height = height;
}

static inline void initTensorVector(OpenDRTensorVectorT *vector) {
    memset(vector, 0, sizeof *vector);
}

static inline void freeTensorVector(OpenDRTensorVectorT *vector) {
    for (int i = 0; i < vector->nTensors; i++) free(vector->datas[i]);
    free(vector->batchSizes); /* one block for all sizes */
    free(vector->datas);
    initTensorVector(vector);
}

static inline void loadTensorVector(OpenDRTensorVectorT *vector, OpenDRTensorT *tensors, int count) {
    size_t places = (size_t)(count > 0 ? count : 0);
    int *sizes = (int *)calloc(places > 0 ? places : 1, 5 * sizeof(int));
    float **datas = (float **)calloc(places > 0 ? places : 1, sizeof(float *));
    initTensorVector(vector);
    if (sizes == NULL || datas == NULL) {
        free(sizes);
        free(datas);
        return;
    }
    vector->batchSizes = sizes;
    vector->frames = sizes + places;
    vector->channels = sizes + 2 * places;
    vector->widths = sizes + 3 * places;
    vector->heights = sizes + 4 * places;
    vector->datas = datas;
    for (vector->nTensors = 0; vector->nTensors < count; vector->nTensors++) {
        int i = vector->nTensors;
        OpenDRTensorT copy;
        loadTensor(&copy, tensors[i].data, tensors[i].batchSize, tensors[i].frames, tensors[i].channels, tensors[i].width,
            tensors[i].height);
        vector->batchSizes[i] = copy.batchSize;
        vector->frames[i] = copy.frames;
        vector->channels[i] = copy.channels;
        vector->widths[i] = copy.width;
        vector->heights[i] = copy.height;
        vector->datas[i] = copy.data;
    }
}

static inline void iterTensorVector(OpenDRTensorT *tensor, OpenDRTensorVectorT *vector, int index) {
    if (index < 0 || index >= vector->nTensors) {
        initTensor(tensor);
        return;
    }
    loadTensor(tensor, vector->datas[index], vector->batchSizes[index], vector->frames[index], vector->channels[index],
        vector->widths[index], vector->heights[index]);
}

/* modelPath "" or NULL takes the pretrained model; modelName is that of the file and not needed here. The model's own size
 * is used: height and width other than 0 are told of on stderr. */
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

/* Draws the boxes onto the picture. There is no window here: show is told of on stderr unless it is 1. */
static inline void drawBboxes(OpenDRImageT *image, NanodetModelT *model, OpenDRDetectionVectorTargetT *vector, int show) {
    opendr_bounding_box_list *boxes = NULL;
    size_t count = vector->size > 0 ? (size_t)vector->size : 0;
    opendr_bounding_box *items = (opendr_bounding_box *)calloc(count > 0 ? count : 1, sizeof *items);
    size_t kept = 0;
    if (items == NULL) return;
    if (show != 1) fprintf(stderr, "drawBboxes: there is no window; save the picture with opendr_image_save()\n");
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

#endif /* OPENDR_COMPAT_H */
