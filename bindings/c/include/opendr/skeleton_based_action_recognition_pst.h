#ifndef OPENDR_SKELETON_BASED_ACTION_RECOGNITION_PST_H
#define OPENDR_SKELETON_BASED_ACTION_RECOGNITION_PST_H

/* A network for skeleton sequences under OpenDR's names; opendr_compat.h explains these headers. There is no pretrained
 * one. */
#include "network_model.h"
#include "target.h"

typedef struct PstModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_network */
    int batchSize;
    int inChannels;
    int features; /* frames */
    int nPoint;
    int nPerson;
    int nClasses;
} PstModelT;

static inline void freePstModel(PstModelT *model) {
    opendr_compat_close(&model->onnxSession);
    memset(model, 0, sizeof *model);
}

/* Loads a network from an ONNX file, or from OpenDR's folder of one. */
static inline void loadPstModel(const char *modelPath, PstModelT *model) {
    const opendr_network *network;
    memset(model, 0, sizeof *model);
    model->onnxSession = opendr_compat_open("loadPstModel", modelPath, NULL, NULL);
    if (model->onnxSession == NULL) return;
    model->env = model->sessionOptions = model->onnxSession;
    network = (const opendr_network *)model->onnxSession;
    model->batchSize = opendr_compat_input_side(network, 0, 128);
    model->inChannels = opendr_compat_input_side(network, 1, 2);
    model->features = opendr_compat_input_side(network, 2, 300);
    model->nPoint = opendr_compat_input_side(network, 3, 18);
    model->nPerson = opendr_compat_input_side(network, 4, 2);
    model->nClasses = opendr_compat_output_side(network, 0, 0, 60);
}

static inline void forwardPst(PstModelT *model, OpenDRTensorT *tensor, OpenDRTensorVectorT *vector) {
    opendr_compat_forward("forwardPst", model->onnxSession, OPENDR_COMPAT_FRAMES_FIRST, tensor, vector);
}

/* As in OpenDR, the tensor's sizes are the network's axes in order: samples, channels, frames, points, persons. */
static inline void initRandomOpenDRTensorPst(OpenDRTensorT *tensor, PstModelT *model) {
    opendr_compat_random(tensor, model->batchSize, model->inChannels, model->features, model->nPoint, model->nPerson);
}

/* OpenDR 2's spelling. */
static inline void initRandomOpendrTensorPst(OpendrTensorT *tensor, PstModelT *model) {
    initRandomOpenDRTensorPst(tensor, model);
}

#endif /* OPENDR_SKELETON_BASED_ACTION_RECOGNITION_PST_H */
