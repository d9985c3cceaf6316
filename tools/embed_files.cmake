# Writes OUT, a C++ file in which FUNCTION of host/embedded_files.h returns every file of FILES (relative to ROOT) as text.
# Called by the build.
file(WRITE ${OUT}.new "#include \"host/embedded_files.h\"\nnamespace etendue {\nconst std::vector<EmbeddedFile>& ${FUNCTION}() {\n    static const std::vector<EmbeddedFile> files = {\n")
foreach(name IN LISTS FILES)
    file(READ ${ROOT}/${name} text)
    file(APPEND ${OUT}.new "{\"${name}\", R\"file_text(${text})file_text\"},\n")
endforeach()
file(APPEND ${OUT}.new "    };\n    return files;\n}\n}  // namespace etendue\n")
file(RENAME ${OUT}.new ${OUT})
