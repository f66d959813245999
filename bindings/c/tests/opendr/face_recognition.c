/* A program written for OpenDR 3.0's C API: face_recognition FOLDER DATABASE IMAGE ... */
#undef NDEBUG
#include <assert.h>

#include "face_recognition.h"
#include "opendr_utils.h"

static void recognise(FaceRecognitionModelT *model, const char *path) {
    OpenDRImageT image;
    OpenDRCategoryTargetT person;
    char name[512];
    loadImage(path, &image);
    assert(image.data != NULL);
    person = inferFaceRecognition(model, &image);
    decodeCategoryFaceRecognition(model, person, name);
    printf("%d %.3f %s\n", person.data, (double)person.confidence, name);
    freeImage(&image);
}

/* A name longer than the buffer of OpenDR's samples. */
static void long_name(void) {
    FaceRecognitionModelT model;
    OpenDRCategoryTargetT person = {0, 1.0f};
    char name[600], *names[1], decoded[513];
    memset(&model, 0, sizeof model);
    memset(name, 'a', sizeof name);
    name[510] = (char)0xC3; /* a letter of two bytes over the limit */
    name[511] = (char)0xA9;
    name[599] = '\0';
    names[0] = name;
    model.personNames = names;
    model.nPersons = 1;
    decoded[512] = 'x';
    decodeCategoryFaceRecognition(&model, person, decoded);
    assert(strlen(decoded) == 510 && decoded[512] == 'x');
    name[509] = (char)0xC3;
    name[510] = (char)0xA9;
    name[511] = 'a';
    decodeCategoryFaceRecognition(&model, person, decoded);
    assert(strlen(decoded) == 511);
    person.data = 1;
    decodeCategoryFaceRecognition(&model, person, decoded);
    assert(decoded[0] == '\0');
}

int main(int argc, char **argv) {
    FaceRecognitionModelT model, missing;
    OpenDRImageT image;
    OpenDRCategoryTargetT person;
    char name[512];
    assert(argc > 3);
    loadFaceRecognitionModel("", &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    assert(model.modelSize == 112 && model.outputSize == 256 && model.threshold > 0.3f && model.nPersons == 0);

    /* No person is enrolled yet. */
    loadImage(argv[3], &image);
    person = inferFaceRecognition(&model, &image);
    assert(person.data == -1 && person.confidence == 0.0f && model.database == NULL);
    freeImage(&image);
    buildDatabaseFaceRecognition("no/such/folder", argv[2], &model);
    assert(model.database == NULL);
    buildDatabaseFaceRecognition(argv[1], "", &model);
    assert(model.database == NULL);

    buildDatabaseFaceRecognition(argv[1], argv[2], &model);
    loadDatabaseFaceRecognition(argv[2], &model);
    assert(model.database != NULL && model.databaseIds != NULL && model.nFeatures >= model.nPersons);
    for (int i = 0; i < model.nPersons; i++) fprintf(stderr, "%s\n", model.personNames[i]);
    for (int i = 3; i < argc; i++) recognise(&model, argv[i]);
    person.data = model.nPersons;
    decodeCategoryFaceRecognition(&model, person, name);
    assert(name[0] == '\0');

    /* Built again into the same model; a failed load leaves no database. */
    buildDatabaseFaceRecognition(argv[1], argv[2], &model);
    assert(model.database != NULL);
    loadDatabaseFaceRecognition("no/such/database", &model);
    assert(model.database == NULL && model.databaseIds == NULL && model.nPersons == 0 && model.onnxSession != NULL);
    loadDatabaseFaceRecognition(argv[2], &model);
    assert(model.database != NULL);
    freeFaceRecognitionModel(&model);
    assert(model.onnxSession == NULL);
    freeFaceRecognitionModel(&model);

    loadFaceRecognitionModel("no/such/model", &missing);
    assert(missing.onnxSession == NULL && missing.env == NULL && missing.sessionOptions == NULL);
    buildDatabaseFaceRecognition(argv[1], argv[2], &missing);
    loadDatabaseFaceRecognition(argv[2], &missing);
    assert(missing.database == NULL);
    freeFaceRecognitionModel(&missing);
    long_name();
    return 0;
}
