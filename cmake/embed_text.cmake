# embed_text(TARGET HEADER VARIABLE FILE): compiles the text of FILE into TARGET as the std::string_view VARIABLE of
# namespace wavecrest, declared extern in HEADER; again whenever FILE changes.
set(WAVECREST_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed_text_run.cmake)

function(embed_text target header variable file)
  get_filename_component(file ${file} ABSOLUTE)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${variable}.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILE=${file} -DOUTPUT=${output} -DHEADER=${header} -DVARIABLE=${variable}
            -P ${WAVECREST_EMBED_SCRIPT}
    DEPENDS ${file} ${WAVECREST_EMBED_SCRIPT} VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
