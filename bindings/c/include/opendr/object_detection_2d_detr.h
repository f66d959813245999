#ifndef OPENDR_OBJECT_DETECTION_2D_DETR_H
#define OPENDR_OBJECT_DETECTION_2D_DETR_H

/* A network of DETR under OpenDR's names; opendr_compat.h explains these headers. There is no pretrained one. */
#include "network_model.h"
#include "target.h"

typedef struct DetrModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    int modelSize;
    float meanValue[3]; /* inputs are (sample / 255 + meanValue) * stdValue */
    float stdValue[3];
    float threshold;
    int features; /* number of objects of an output */
    int outputSizes[2]; /* length of an object's output: classes, box */
} DetrModelT;

static inline void freeDetrModel(DetrModelT *model) {
    opendr_compat_close(&model->onnxSession);
    memset(model, 0, sizeof *model);
}

/* Loads a network from an ONNX file, or from OpenDR's folder, whose JSON has the threshold. */
static inline void loadDetrModel(const char *modelPath, DetrModelT *model) {
    static const float mean[3] = {-0.485f, -0.456f, -0.406f}, std[3] = {0.229f, 0.224f, 0.225f};
    const opendr_network *network;
    opendr_string *manifest = NULL;
    memset(model, 0, sizeof *model);
    model->onnxSession = opendr_compat_open("loadDetrModel", modelPath, NULL, NULL);
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    if (opendr_network_manifest(network, &manifest) == OPENDR_OK)
        model->threshold = (float)opendr_json_number(opendr_string_text(manifest), "params", "threshold", 0);
    opendr_string_free(&manifest);
    model->modelSize = opendr_compat_input_side(network, 3, 800);
    model->features = opendr_compat_output_side(network, 0, 1, 100);
    model->outputSizes[0] = opendr_compat_output_side(network, 0, 0, 92);
    model->outputSizes[1] = opendr_compat_output_side(network, 1, 0, 4);
    for (int i = 0; i < 3; i++) {
        model->meanValue[i] = mean[i];
        model->stdValue[i] = 1.0f / std[i];
    }
}

static inline void forwardDetr(DetrModelT *model, OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    opendr_compat_forward("forwardDetr", model->onnxSession, OPENDR_COMPAT_FRAMES_FIRST, tensor, vector);
}

static inline void initRandomOpenDRTensorDetr(OpenDRTensorT *tensor, DetrModelT *model) {
    opendr_compat_random(tensor, 1, 1, 3, model->modelSize, model->modelSize);
}

/* OpenDR 2's spelling. */
static inline void initRandomOpendrTensorDetr(OpendrTensorT *tensor, DetrModelT *model) {
    initRandomOpenDRTensorDetr(tensor, model);
}

#endif /* OPENDR_OBJECT_DETECTION_2D_DETR_H */
