#include "capstan/service/page_policy.h"

#include <openssl/evp.h>

#include "capstan/reports/embedded_files.h"

namespace capstan::service {

namespace {

// 'sha256-...' of CSP 2.
std::string hash_source(std::string_view script) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    ::EVP_Digest(script.data(), script.size(), digest, &size, EVP_sha256(), nullptr);
    unsigned char base64[2 * EVP_MAX_MD_SIZE];
    const int length = ::EVP_EncodeBlock(base64, digest, static_cast<int>(size));
    return " 'sha256-" +
           std::string(reinterpret_cast<const char*>(base64), static_cast<std::size_t>(length)) + "'";
}

std::string policy_with(const std::string& scripts) {
    return "default-src 'none'; script-src 'self' 'unsafe-eval'" + scripts +
           "; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src 'self' data: blob:; form-action "
           "'self'; base-uri 'none'; frame-ancestors 'none'";
}

}  // namespace

const std::string& page_policy() {
    static const std::string policy = policy_with("");
    return policy;
}

const std::string& self_contained_page_policy() {
    static const std::string policy = [] {
        std::string hashes;
        for (const char* name : {"vega.min.js", "vega-lite.min.js", "vega-embed.min.js", "page.js"})
            hashes += hash_source(reports::embedded_file(name));
        return policy_with(hashes);
    }();
    return policy;
}

}  // namespace capstan::service
