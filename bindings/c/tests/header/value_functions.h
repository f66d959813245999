/*
 * Functions of each data and target type X: opendr_X_free(), opendr_X_copy(), opendr_X_to_text(), opendr_X_stamp(),
 * opendr_X_set_stamp(), opendr_X_frame_id(), opendr_X_set_frame_id(); see the functions opendr_value_free(), ... .
 */
#define OPENDR_VALUE_FUNCTIONS(X) \
    static inline opendr_status X##_free(X **variable) { \
        opendr_value *value = variable == NULL ? NULL : (opendr_value *)*variable; \
        opendr_status status = opendr_value_free(variable == NULL ? NULL : &value); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_copy(const X *value, X **variable) { \
        opendr_value *copy = NULL; \
        opendr_status status = opendr_value_copy((const opendr_value *)value, variable == NULL ? NULL : &copy); \
        if (variable != NULL) *variable = (X *)copy; \
        return status; \
    } \
    static inline opendr_status X##_to_text(const X *value, opendr_string **text) { \
        return opendr_value_to_text((const opendr_value *)value, text); \
    } \
    static inline opendr_status X##_stamp(const X *value, int64_t *stamp_ns) { \
        return opendr_value_stamp((const opendr_value *)value, stamp_ns); \
    } \
    static inline opendr_status X##_set_stamp(X *value, int64_t stamp_ns) { \
        return opendr_value_set_stamp((opendr_value *)value, stamp_ns); \
    } \
    static inline const char *X##_frame_id(const X *value) { \
        return opendr_value_frame_id((const opendr_value *)value); \
    } \
    static inline opendr_status X##_set_frame_id(X *value, const char *frame_id) { \
        return opendr_value_set_frame_id((opendr_value *)value, frame_id); \
    }

/* Further functions of each target type X: opendr_X_to_json(), opendr_X_from_json() and opendr_X_draw(). */
#define OPENDR_TARGET_FUNCTIONS(X, name) \
    static inline opendr_status X##_to_json(const X *value, opendr_string **json) { \
        return opendr_value_to_json((const opendr_value *)value, json); \
    } \
    static inline opendr_status X##_from_json(const char *json, X **variable) { \
        opendr_value *value = NULL; \
        opendr_status status = opendr_value_from_json(name, json, variable == NULL ? NULL : &value); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_draw(const X *value, opendr_image *image) { \
        return opendr_value_draw((const opendr_value *)value, image); \
    }

/* Further functions of each array type X: opendr_X_create() and opendr_X_read(); see opendr_array_create(). */
#define OPENDR_ARRAY_FUNCTIONS(X, name, axes) \
    static inline opendr_status X##_create(const float *numbers, size_t length, const size_t shape[axes], X **variable) { \
        opendr_value *value = NULL; \
        opendr_value **place = variable == NULL ? NULL : &value; \
        opendr_status status = opendr_array_create(name, numbers, length, shape, axes, place); \
        if (variable != NULL) *variable = (X *)value; \
        return status; \
    } \
    static inline opendr_status X##_read(const X *value, const float **numbers, size_t *length, size_t shape[axes]) { \
        return opendr_array_read((const opendr_value *)value, numbers, length, shape, axes); \
    }

