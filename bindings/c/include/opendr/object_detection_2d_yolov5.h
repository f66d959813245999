#ifndef OPENDR_OBJECT_DETECTION_2D_YOLOV5_H
#define OPENDR_OBJECT_DETECTION_2D_YOLOV5_H

/* A network of YOLOv5 under OpenDR's names; opendr_compat.h explains these headers. Its outputs are not decoded to boxes yet. */
#include "network_model.h"
#include "target.h"

typedef struct Yolov5Model {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    float confThreshold;
    float iouThreshold;
    OpenDRStringsVectorT labels;
    int **colorList; /* red, green and blue of each class */
    int numberOfClasses;
    int inputSizes[2]; /* width and height */
    int isDynamicInputShape; /* as in OpenDR: 0 for a network with dynamic input size, 1 for a fixed one */
} Yolov5ModelT;

static inline void freeYolov5Model(Yolov5ModelT *model) {
    opendr_compat_close(&model->onnxSession);
    freeStringsVector(&model->labels);
    for (int i = 0; model->colorList != NULL && i < model->numberOfClasses; i++) free(model->colorList[i]);
    free(model->colorList);
    memset(model, 0, sizeof *model);
}

/* Opens modelPath/yolov5NAME.json, one of several models in a folder, if it exists, else modelPath. */
static inline opendr_network *opendr_compat_open_yolov5(const char *modelPath, const char *modelName, const char *device) {
    const char *name = modelName != NULL ? modelName : "";
    const char *path = modelPath != NULL ? modelPath : "";
    size_t size = strlen(path) + strlen(name) + sizeof "/yolov5.json";
    char *json = (char *)malloc(size);
    opendr_network *network = NULL;
    opendr_status status = OPENDR_NOT_FOUND;
    if (json != NULL && path[0] != '\0') {
        snprintf(json, size, "%s/yolov5%s.json", path, name);
        status = opendr_network_open(json, NULL, device, &network);
    }
    free(json);
    if (status == OPENDR_OK) return network;
    return opendr_compat_open("loadYolov5Model", path, device, NULL);
}

/* Copies the names of the classes and gives each a colour. */
static inline void opendr_compat_label_yolov5(Yolov5ModelT *model, const char *manifest) {
    int count = 0;
    while (count < INT_MAX && opendr_json_text(manifest, NULL, "classes", count)[0] != '\0') count++;
    model->labels.data = (char **)calloc((size_t)(count > 0 ? count : 1), sizeof(char *));
    model->colorList = (int **)calloc((size_t)(count > 0 ? count : 1), sizeof(int *));
    if (model->labels.data == NULL || model->colorList == NULL) return;
    for (int i = 0; i < count; i++) {
        const char *label = opendr_json_text(manifest, NULL, "classes", i);
        model->labels.data[i] = (char *)malloc(strlen(label) + 1);
        model->colorList[i] = (int *)malloc(3 * sizeof(int));
        model->labels.size = model->numberOfClasses = i + 1;
        if (model->labels.data[i] == NULL || model->colorList[i] == NULL) return;
        strcpy(model->labels.data[i], label);
        for (int channel = 0; channel < 3; channel++) model->colorList[i][channel] = (i * 97 + channel * 85 + 37) % 256;
    }
}

/* Loads a network from an ONNX file, or from OpenDR's folder, whose JSON has the classes. Thresholds of 0 are replaced by
 * those of the JSON, height and width of 0 by those of the network's training. */
static inline void loadYolov5Model(const char *modelPath, const char *modelName, const char *device, float confThreshold,
    float iouThreshold, int height, int width, Yolov5ModelT *model) {
    const opendr_network *network;
    opendr_string *manifest = NULL;
    const char *json;
    int sides[2];
    memset(model, 0, sizeof *model);
    model->onnxSession = opendr_compat_open_yolov5(modelPath, modelName, device);
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    opendr_network_manifest(network, &manifest);
    json = opendr_string_text(manifest);
    model->confThreshold =
        confThreshold > 0.0f ? confThreshold : (float)opendr_json_number(json, "params", "conf_threshold", 0);
    model->iouThreshold =
        iouThreshold > 0.0f ? iouThreshold : (float)opendr_json_number(json, "params", "iou_threshold", 0);
    opendr_compat_label_yolov5(model, json);
    for (int i = 0; i < 2; i++) {
        int trained = (int)opendr_json_number(json, "params", "input_size", i);
        sides[i] = opendr_compat_input_side(network, (size_t)(3 - i), 0);
        model->inputSizes[i] = sides[i] > 0 ? sides[i] : trained > 0 ? trained : 640;
    }
    model->isDynamicInputShape = sides[0] == 0 && sides[1] == 0 ? 0 : 1;
    if (width != 0) model->inputSizes[0] = width;
    if (height != 0) model->inputSizes[1] = height;
    opendr_string_free(&manifest);
}

/* Returns an empty vector and sets the last error to OPENDR_UNSUPPORTED. */
static inline OpenDRDetectionVectorTargetT inferYolov5(Yolov5ModelT *model, OpenDRImageT *image) {
    OpenDRDetectionVectorTargetT vector;
    (void)model;
    (void)image;
    opendr_compat_fail("inferYolov5",
        "OPENDR_UNSUPPORTED: nothing finds boxes in the outputs of YOLOv5; run its network with opendr_network_run()");
    initDetectionsVector(&vector);
    return vector;
}

#endif /* OPENDR_OBJECT_DETECTION_2D_YOLOV5_H */
