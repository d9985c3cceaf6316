# Writes OUT, a C++ file that holds every file of FILES (relative to ROOT) as text. Called by the build.
file(WRITE ${OUT}.new "#include \"host/gpu/shader_source.h\"\nnamespace etendue {\nconst std::vector<EmbeddedFile>& embedded_shaders() {\n    static const std::vector<EmbeddedFile> files = {\n")
foreach(name IN LISTS FILES)
    file(READ ${ROOT}/${name} text)
    file(APPEND ${OUT}.new "{\"${name}\", R\"shader_text(${text})shader_text\"},\n")
endforeach()
file(APPEND ${OUT}.new "    };\n    return files;\n}\n}  // namespace etendue\n")
file(RENAME ${OUT}.new ${OUT})
