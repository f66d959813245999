#ifndef OPENDR_FACE_RECOGNITION_H
#define OPENDR_FACE_RECOGNITION_H

/* Face recognition under OpenDR's names; opendr_compat.h explains these headers. */
#include "network_model.h"
#include "target.h"

/* Maximum number of bytes that decodeCategoryFaceRecognition() writes, including the terminating zero. */
#define OPENDR_PERSON_NAME_SIZE 512

typedef struct FaceRecognitionModel {
    void *onnxSession, *env, *sessionOptions; /* the same opendr_learner */
    int modelSize; /* width and height of the network's input */
    int resizeSize; /* the same: faces are aligned and scaled in one step */
    float meanValue; /* 0 and 1: the network takes unnormalised samples */
    float stdValue;
    float threshold; /* minimum cosine similarity of a face and a person */
    int outputSize; /* length of an embedding */
    void *database; /* NULL without enrolled persons, else the learner */
    int *databaseIds; /* 0, 1, 2, ..., one per person; the learner has the embeddings */
    char **personNames;
    int nPersons;
    int nFeatures; /* the same as nPersons */
} FaceRecognitionModelT;

/* Returns a text escaped for a JSON string, which must be freed; NULL when out of memory. */
static inline char *opendr_compat_json_quoted(const char *text) {
    char *quoted = (char *)malloc(6 * strlen(text) + 1);
    size_t end = 0;
    for (; quoted != NULL && *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') quoted[end++] = '\\';
        if ((unsigned char)*text < 0x20) end += (size_t)sprintf(quoted + end, "\\u%04x", (unsigned)*text);
        else quoted[end++] = *text;
    }
    if (quoted != NULL) quoted[end] = '\0';
    return quoted;
}

static inline void opendr_compat_forget_persons(FaceRecognitionModelT *model) {
    for (int i = 0; i < model->nPersons; i++) free(model->personNames[i]);
    free(model->personNames);
    free(model->databaseIds);
    model->database = NULL;
    model->databaseIds = NULL;
    model->personNames = NULL;
    model->nPersons = model->nFeatures = 0;
}

/* Copies the persons of the learner into the model. */
static inline void opendr_compat_know_persons(FaceRecognitionModelT *model) {
    const opendr_learner *learner = (const opendr_learner *)model->onnxSession;
    size_t count = 0;
    opendr_compat_forget_persons(model);
    opendr_class_count(learner, &count);
    if (count == 0 || count > INT_MAX) return;
    model->personNames = (char **)calloc(count, sizeof(char *));
    model->databaseIds = (int *)calloc(count, sizeof(int));
    while (model->personNames != NULL && model->databaseIds != NULL && model->nPersons < (int)count) {
        const char *name = opendr_class_name(learner, model->nPersons);
        char *copy = (char *)malloc(strlen(name != NULL ? name : "") + 1);
        if (copy == NULL) break;
        strcpy(copy, name != NULL ? name : "");
        model->databaseIds[model->nPersons] = model->nPersons;
        model->personNames[model->nPersons++] = copy;
    }
    model->nFeatures = model->nPersons;
    model->database = model->nPersons == (int)count ? model->onnxSession : NULL;
}

static inline void freeFaceRecognitionModel(FaceRecognitionModelT *model) {
    opendr_learner *learner = (opendr_learner *)model->onnxSession;
    opendr_compat_forget_persons(model);
    opendr_learner_free(&learner);
    memset(model, 0, sizeof *model);
}

/* Loads a model container; modelPath "" or NULL loads the pretrained model. */
static inline void loadFaceRecognitionModel(const char *modelPath, FaceRecognitionModelT *model) {
    const char *path = modelPath != NULL && modelPath[0] != '\0' ? modelPath : NULL;
    opendr_learner *learner = NULL;
    opendr_network *network = NULL;
    opendr_string *params = NULL;
    memset(model, 0, sizeof *model);
    if (opendr_load("face_recognition", path, NULL, NULL, &learner) != OPENDR_OK
        || opendr_learner_network(learner, NULL, &network) != OPENDR_OK || opendr_params(learner, &params) != OPENDR_OK) {
        fprintf(stderr, "loadFaceRecognitionModel: %s\n", opendr_last_error());
        opendr_learner_free(&learner);
    } else {
        model->onnxSession = model->env = model->sessionOptions = learner;
        model->modelSize = model->resizeSize = opendr_compat_input_side(network, 2, 112);
        model->stdValue = 1.0f;
        model->threshold = (float)opendr_json_number(opendr_string_text(params), NULL, "threshold", 0);
        model->outputSize = opendr_compat_output_side(network, 0, 0, 0);
        opendr_compat_know_persons(model);
    }
    opendr_string_free(&params);
    opendr_network_free(&network);
}

/* Returns the person of the largest face in an image, with its score. data is -1 for an unknown person and if no face is
 * detected; confidence is 0 then. */
static inline OpenDRCategoryTargetT inferFaceRecognition(FaceRecognitionModelT *model, OpenDRImageT *image) {
    OpenDRCategoryTargetT target = {-1, 0.0f};
    opendr_bounding_box_list *faces = NULL;
    opendr_output output = {"boxes", NULL};
    opendr_input input = {"image", NULL};
    float largest = -1.0f;
    if (model->database == NULL) {
        opendr_compat_fail("inferFaceRecognition", "no person is known; load a database first");
        return target;
    }
    input.value = (const opendr_value *)image->data;
    if (opendr_infer((const opendr_learner *)model->onnxSession, &input, 1, &output, 1) != OPENDR_OK)
        fprintf(stderr, "inferFaceRecognition: %s\n", opendr_last_error());
    faces = (opendr_bounding_box_list *)output.value;
    for (size_t i = 0; faces != NULL && i < opendr_bounding_box_list_count(faces); i++) {
        opendr_bounding_box face;
        if (opendr_bounding_box_list_get(faces, i, &face) != OPENDR_OK || face.width * face.height <= largest) continue;
        largest = face.width * face.height;
        target.data = (int)face.class_index;
        target.confidence = face.confidence;
    }
    opendr_bounding_box_list_free(&faces);
    return target;
}

/* Enrols the persons whose images are in databaseFolder, in a folder with the name of each, and writes the model with them
 * into the folder outputPath, over an existing one. Images without a face are skipped. */
static inline void buildDatabaseFaceRecognition(const char *databaseFolder, const char *outputPath,
    FaceRecognitionModelT *model) {
    char *output = opendr_compat_json_quoted(outputPath != NULL ? outputPath : "");
    size_t size = (output != NULL ? strlen(output) : 0) + 80;
    char *options = (char *)malloc(size);
    opendr_string *report = NULL;
    if (output != NULL && output[0] == '\0') {
        opendr_compat_fail("buildDatabaseFaceRecognition", "outputPath is empty; give a folder to write to");
    } else if (output != NULL && options != NULL) {
        /* With "resume", the results of an earlier call in the folder are overwritten. */
        snprintf(options, size, "{\"output\": \"%s\", \"resume\": true, \"skip_broken\": true}", output);
        if (opendr_fit((const opendr_learner *)model->onnxSession, databaseFolder, "imagenet", options, NULL, NULL, &report)
            == OPENDR_OK)
            opendr_compat_know_persons(model);
        else
            fprintf(stderr, "buildDatabaseFaceRecognition: %s\n", opendr_last_error());
    }
    opendr_string_free(&report);
    free(options);
    free(output);
}

/* Loads a database that buildDatabaseFaceRecognition() wrote, or a model container with persons. database is NULL if it
 * fails. */
static inline void loadDatabaseFaceRecognition(const char *databasePath, FaceRecognitionModelT *model) {
    const char *path = databasePath != NULL ? databasePath : "";
    opendr_learner *old = (opendr_learner *)model->onnxSession, *learner = NULL;
    opendr_string *params = NULL;
    char *inner = (char *)malloc(strlen(path) + sizeof "/model");
    opendr_compat_forget_persons(model);
    if (inner != NULL && opendr_params(old, &params) == OPENDR_OK) {
        opendr_status status;
        const char *json = opendr_string_text(params);
        sprintf(inner, "%s/model", path);
        status = opendr_load("face_recognition", inner, NULL, json, &learner);
        if (status == OPENDR_NOT_FOUND) opendr_load("face_recognition", path, NULL, json, &learner);
    }
    if (learner == NULL) {
        fprintf(stderr, "loadDatabaseFaceRecognition: %s\n", opendr_last_error());
    } else {
        opendr_learner_free(&old);
        model->onnxSession = model->env = model->sessionOptions = learner;
        opendr_compat_know_persons(model);
    }
    opendr_string_free(&params);
    free(inner);
}

/* Writes the name of a person, at most OPENDR_PERSON_NAME_SIZE bytes including the zero; a longer name is truncated between
 * characters, and an unknown person has the name "". */
static inline void decodeCategoryFaceRecognition(FaceRecognitionModelT *model, OpenDRCategoryTargetT category,
    char *personName) {
    const char *name = category.data >= 0 && category.data < model->nPersons ? model->personNames[category.data] : "";
    size_t length = strlen(name);
    if (length >= OPENDR_PERSON_NAME_SIZE) {
        length = OPENDR_PERSON_NAME_SIZE - 1;
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) length--;
    }
    memcpy(personName, name, length);
    personName[length] = '\0';
}

#endif /* OPENDR_FACE_RECOGNITION_H */
